// expect: nysalt: a word needs a letter beside those of the bath
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/flows/drift.hpp"

using O = nysalt::ornstein_uhlenbeck;

int main() {
#ifdef NYSALT_CONTROL
  using some = nysalt::word<O, nysalt::drift>;
#else
  // [mistake]
  using some = nysalt::word<O, O>;
  // [/mistake]
#endif
  return nysalt::conservative_word<some>::length == 1 ? 0 : 1;
}
