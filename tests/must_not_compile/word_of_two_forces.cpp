// expect: the letters A, B, G split H into K and V, and R, S, H into its quadratic part
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/word.hpp"

int main() {
#ifdef NYSALT_CONTROL
  using first = nysalt::soft_kick;
#else
  using first = nysalt::kick;
#endif
  return nysalt::word<first, nysalt::rotation, nysalt::soft_kick>::length == 3 ? 0 : 1;
}
