// SPDX-License-Identifier: BSL-1.0
// Export to OrdinaryDiffEq.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_ordinarydiffeq(const exported_method& method) {
  const exported_letters word = composition_of(method, "OrdinaryDiffEq");
  const auto [drifts, kicks] = in_stages(word, 'A');
  auto values = values_of_header(method, "#");
  values.emplace_back("A", digits(kicks));
  values.emplace_back("B", digits(drifts));
  return fill(R"(@HEADER@#
@EXPLAINED@
# The tableau of OrdinaryDiffEqSymplecticRK: stage i is u += b[i] dt f2(du), then du += a[i] dt f1(u). Its stages
# evaluate f1 also where a[i] is zero.
# Test, of a stand-in with the loop of OrdinaryDiffEq: julia -e 'include("FILE"); exit(nysalt_@NAME@.self_test() < 1e-13 ? 0 : 1)'
module nysalt_@NAME@

const a = (@A@,)
const b = (@B@,)

# The tableau, for the module OrdinaryDiffEqSymplecticRK.
tableau(OrdinaryDiffEqSymplecticRK) = OrdinaryDiffEqSymplecticRK.SymplecticTableau(a, b)

# By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding.
function self_test()
    q, p, inverse_mass, h = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5], 0.1
    for _ in 1:10, i in eachindex(a)
        q .+= h * b[i] .* inverse_mass .* p
        f = [-q[1] - 2 * q[1] * q[2], -q[2] - q[1]^2 + q[2]^2]
        p .+= h * a[i] .* f
    end
    return max(maximum(abs.(q - [@Q@])), maximum(abs.(p - [@P@])))
end

end
)",
              values);
}

}  // namespace nysalt::detail
