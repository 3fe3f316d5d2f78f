// expect: nysalt: this word has its letters O already
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/baoab.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/methods/verlet.hpp"

int main() {
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::verlet()).coefficients();
#else
  // [mistake]
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::baoab()).coefficients();
  // [/mistake]
#endif
}
