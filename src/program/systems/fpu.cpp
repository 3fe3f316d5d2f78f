// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

namespace {
template <int Pairs>
initial_value_problem made(const fpu_chain<Pairs>& chain, const bath& in, const fpu_law<Pairs>& law) {
  auto result = detail::made_of(chain, in, law, chain.omega());
  result.default_observable = "stiff_energy";
  return result;
}
}  // namespace

system_declaration declare_fpu() {
  system_declaration fpu{.name = "fpu",
                         .title = "Fermi-Pasta-Ulam chain: stiff linear and soft quartic springs in turn"};
  fpu.parameters = {{.name = "pairs",
                     .usual = 3,
                     .meaning = "number of pairs of masses",
                     .least = 1,
                     .most = 10'000'000},  // a run takes some gigabytes
                    {.name = "omega", .usual = 50.0, .meaning = "frequency of the stiff springs"}};
  fpu.make = [](const parameter_values& values, const bath& in, double spread) {
    const auto pairs = values.whole("pairs");
    const double omega = values.real("omega");
    if (pairs == 3) {  // the paper's, of a size known to the compiler
      const fpu_chain<3> chain(omega);
      return made(chain, in, fpu_law<3>(chain, spread));
    }
    const fpu_chain<> chain(pairs, omega);
    return made(chain, in, fpu_law<Eigen::Dynamic>(chain, spread));
  };
  fpu.described = "fpu_chain";
  fpu.source = "hairer_lubich_wanner_2006";
  return fpu;
}

}  // namespace nysalt::program
