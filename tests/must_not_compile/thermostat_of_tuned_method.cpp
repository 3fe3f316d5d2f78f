// expect: thermostat its anywhere()
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/thermostatted.hpp"

int main() {
  const nysalt::member<nysalt::nystrom> plain({0.5, 0.4});
  const nysalt::tuned_method<nysalt::nystrom> tuned(plain, 0.1, "a system");
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::end>(tuned.anywhere());
#else
  nysalt::thermostat<nysalt::placement::end>(tuned);
#endif
}
