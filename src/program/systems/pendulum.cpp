// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt::program {

system_declaration declare_pendulum() {
  system_declaration result{.name = "pendulum", .title = "p^2/2 - cos q"};
  result.make = [](const parameter_values&, const bath& in, double spread) {
    // Swings: the pendulum goes over the top from |p| = 2 at the bottom.
    const vector<double, 1> rest(0.0);
    const normal_around<1> law({rest, rest}, 0.5 * spread, 0.5 * spread);
    return detail::made_of(pendulum(), in, law, 1.0);
  };
  return result;
}

}  // namespace nysalt::program
