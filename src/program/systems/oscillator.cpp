// SPDX-License-Identifier: BSL-1.0
#include "comparison/prepared_problem.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/textbook.hpp"
#include "with_exact_flow.hpp"

namespace nysalt::program {

system_declaration declare_oscillator() {
  system_declaration result{.name = "oscillator", .title = "p^2/2 + omega^2 q^2/2"};
  result.parameters = {{.name = "omega", .usual = 50.0, .meaning = "frequency"}};
  result.make = [](const parameter_values& values, const bath& in, double spread) {
    const double omega = values.real("omega");
    const harmonic_oscillator oscillator(omega);
    // Of energy kT = 1 in the mean.
    const vector<double, 1> rest(0.0);
    const normal_around<1> law({rest, rest}, spread / omega, spread);
    return with_exact_flow(oscillator, in, detail::made_of(oscillator, in, law, omega));
  };
  result.described = "harmonic_oscillator";
  return result;
}

}  // namespace nysalt::program
