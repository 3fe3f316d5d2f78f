// expect: nysalt: a word with an even number of letters has no central letter to split
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/langevin.hpp"

// [mistake]
using euler = nysalt::word<nysalt::kick, nysalt::drift>;
// [/mistake]

int main() {
#ifdef NYSALT_CONTROL
  return nysalt::thermostatted_word<euler, nysalt::placement::end>::length == 3 ? 0 : 1;
#else
  return nysalt::thermostatted_word<euler, nysalt::placement::middle>::length == 3 ? 0 : 1;
#endif
}
