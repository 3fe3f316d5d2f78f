// expect: nysalt: this word has its letters O already
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"

int main() {
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::verlet()).coefficients();
#else
  // [mistake]
  nysalt::thermostat<nysalt::placement::symmetric>(nysalt::baoab()).coefficients();
  // [/mistake]
#endif
}
