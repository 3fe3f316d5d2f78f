// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/phi4.hpp"

namespace nysalt::program {

system_declaration declare_phi4() {
  system_declaration result{.name = "phi4",
                            .title = "masses in wells q^4/4, a ring joined by linear springs"};
  result.parameters = {{.name = "masses",
                        .usual = 16,
                        .meaning = "number of masses",
                        .least = 1,
                        .most = 10'000'000}};  // a state of some hundred megabytes
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const auto masses = values.whole("masses");
    const phi4_chain<> chain(masses);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(masses);
    // Near kT = 1, where springs and wells matter alike.
    const double q = 0.5 * spread;
    const double p = spread;
    // A well may hold what a mass has that starts at five deviations of both.
    const double well_energy = 12.5 * p * p + std::pow(5.0 * q, 4) / 4.0;
    const double fastest = chain.frequency_bands(well_energy).back().high;
    const normal_around<Eigen::Dynamic> law({rest, rest}, q, p);
    return detail::made_of(chain, in, law, fastest);
  };
  result.described = "phi4_chain";
  result.source = "aoki_kusnezov_2002";
  return result;
}

}  // namespace nysalt::program
