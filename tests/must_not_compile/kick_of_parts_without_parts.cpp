// expect: nysalt: a kick of parts needs a system that declares them, such as sum_of_parts
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick_of_parts.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/sum_of_parts.hpp"

int main() {
#ifdef NYSALT_CONTROL
  const nysalt::sum_of_parts<nysalt::pendulum> system{nysalt::pendulum()};
#else
  // [mistake]
  const nysalt::pendulum system;
  // [/mistake]
#endif
  nysalt::stepper<std::remove_const_t<decltype(system)>,
                  nysalt::word<nysalt::kick_of_part<0>, nysalt::drift>>(system, {1.0, 1.0}, 0.1);
}
