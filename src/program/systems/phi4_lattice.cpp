// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/phi4.hpp"

#include <algorithm>
#include <cmath>

#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

system_declaration declare_phi4_lattice() {
  system_declaration result{.name = "phi4_lattice", .title = "lattice phi^4 theory on a periodic square"};
  result.parameters = {
      {.name = "side", .usual = 12, .meaning = "number of sites of a row", .least = 2, .most = 4096},
      {.name = "mass_squared", .usual = -4.0, .meaning = "the square m^2 of the mass"},
      {.name = "coupling", .usual = 4.0, .meaning = "the coupling lambda", .is_positive = true}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const phi4_lattice lattice(values.whole("side"), values.real("mass_squared"), values.real("coupling"));
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(lattice.size());
    // As large as fields are at kT = 1 and a coupling of order one.
    const double q = 0.4 * spread;
    const normal_around<Eigen::Dynamic> law({rest, rest}, q, spread);
    // Where neighbours alternate, at five deviations.
    const double stiffness = 2.0 * lattice.mass_squared() + 16.0 + 12.0 * lattice.coupling() * 25.0 * q * q;
    return detail::made_of(lattice, in, law, std::sqrt(std::max(stiffness, 1.0)));
  };
  result.described = "phi4_lattice";
  result.source = "albergo_kanwar_shanahan_2019";
  return result;
}

}  // namespace nysalt::program
