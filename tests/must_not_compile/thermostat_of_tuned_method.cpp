// expect: nysalt: a tuned method is valid for the system that it was learned for; thermostat its anywhere()
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/thermostatted.hpp"

int main() {
  const nysalt::member<nysalt::nystrom> plain({0.5, 0.4});
  const nysalt::tuned_method<nysalt::nystrom> tuned(plain, 0.1, "a system");
#ifdef NYSALT_CONTROL
  nysalt::thermostat<nysalt::placement::end>(tuned.anywhere());
#else
  // [mistake]
  nysalt::thermostat<nysalt::placement::end>(tuned);
  // [/mistake]
#endif
}
