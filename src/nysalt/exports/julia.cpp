// SPDX-License-Identifier: BSL-1.0
// Export to Julia.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_julia(const exported_method& method) {
  auto values = values_of(method, "#");
  add_bath(
      values, method,
      {{"BATH_NONE", ", bath=nothing"},
       {"BATH_PARAMETER", ", friction, temperature, normal"},
       {"BATH_SENTENCE",
        "# The temperature is kT; normal(size) is an array of standard normal numbers: randn.\n"},
       {"BATH", ", (friction, temperature, normal)"},
       {"BATH_BRANCH", R"(        if letter == 'O'
            friction, temperature, normal = bath
            damping = friction * c[k] * h
            p .= exp(-damping) .* p .+ sqrt.(-expm1(-2 * damping) * temperature ./ inverse_mass) .* normal(size(p))
            k += 1
            continue
        end
)"},
       {"BATH_PINNED", "    drawn = Ref(0)\n    sines(size) = [sin(drawn[] += 1) for _ in 1:prod(size)]\n"},
       {"BATH_TEST", ", 1.5, 0.7, sines"}});
  return fill(R"(@HEADER@#
@EXPLAINED@
# A run is start! once, steps!, and finish! on a copy of q and p that is observed; without a processor start! and
# finish! do nothing. A force that is known is not evaluated again, also from step to step.
# Test: julia -e 'include("FILE"); exit(nysalt_@NAME@.self_test() < 1e-13 ? 0 : 1)'
module nysalt_@NAME@

const KERNEL = ("@KERNEL@", [@KERNEL_COEFFICIENTS@])
const START = ("@START@", [@START_COEFFICIENTS@])
const FINISH = ("@FINISH@", [@FINISH_COEFFICIENTS@])

# One pass over the letters of a word; whether f is the force at q.
function apply!(word, known, f, q, p, h, force, inverse_mass@BATH_NONE@)
    letters, c = word
    k = 1
    for letter in letters
        if letter == 'A'
            q .+= c[k] .* h .* inverse_mass .* p
            known = false
            k += 1
            continue
        end
@BATH_BRANCH@        known || (f .= force(q))
        known = true
        if letter == 'B'
            p .+= c[k] .* h .* f
            k += 1
        else
            p .+= c[k] .* h .* force(q .+ c[k+1] .* h^2 .* inverse_mass .* f)
            k += 2
        end
    end
    return known
end

start!(q, p, h, force, inverse_mass) = (apply!(START, false, similar(p), q, p, h, force, inverse_mass); nothing)

@BATH_SENTENCE@function steps!(q, p, h, count, force, inverse_mass@BATH_PARAMETER@)
    f = similar(p)
    known = false
    for _ in 1:count
        known = apply!(KERNEL, known, f, q, p, h, force, inverse_mass@BATH@)
    end
end

finish!(q, p, h, force, inverse_mass) = (apply!(FINISH, false, similar(p), q, p, h, force, inverse_mass); nothing)

# By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding.
function self_test()
    force(q) = [-q[1] - 2 * q[1] * q[2], -q[2] - q[1]^2 + q[2]^2]
    q, p, inverse_mass = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5]
@BATH_PINNED@    start!(q, p, 0.1, force, inverse_mass)
    steps!(q, p, 0.1, 10, force, inverse_mass@BATH_TEST@)
    finish!(q, p, 0.1, force, inverse_mass)
    return max(maximum(abs.(q - [@Q@])), maximum(abs.(p - [@P@])))
end

end
)",
              values);
}

}  // namespace nysalt::detail
