// expect GNU: required for the satisfaction of 'CoefficientOf<C, T>' [with C = nysalt::dual<double, 2>; T =
//   nysalt::dual<double, 1>]
// expect Clang: because 'CoefficientOf<nysalt::dual<double, 2>, nysalt::dual<double, 1> >' evaluated to false
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/families/nystrom.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/pendulum.hpp"

// Coefficients with derivatives by two parameters cannot step a state that carries one derivative.
int main() {
  using two = nysalt::dual<double, 2>;
#ifdef NYSALT_CONTROL
  using state = two;
#else
  // [mistake]
  using state = nysalt::dual<double, 1>;
  // [/mistake]
#endif
  const nysalt::pendulum system;
  const nysalt::stepper<nysalt::pendulum, nysalt::nystrom::word, two> fixed(
      system, nysalt::nystrom::coefficients(std::array<two, 2>{0.5, 0.4}), 0.1);
  nysalt::flow_state<state, 1> x;
  fixed.step(x);
}
