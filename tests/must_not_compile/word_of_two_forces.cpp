// expect: nysalt: the letters A, B, D, G split H into K and V, and R, S, H into its quadratic part and the
// rest:
//   a word has those of one splitting
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/word.hpp"

int main() {
#ifdef NYSALT_CONTROL
  using mixed = nysalt::word<nysalt::soft_kick, nysalt::rotation, nysalt::soft_kick>;
#else
  // [mistake]
  using mixed = nysalt::word<nysalt::kick, nysalt::rotation, nysalt::soft_kick>;
  // [/mistake]
#endif
  return mixed::length == 3 ? 0 : 1;
}
