// expect: nysalt: no classical method has this name
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/classical.hpp"

int main() {
#ifdef NYSALT_CONTROL
  nysalt::classical<"pefrl">::coefficients();
#else
  // [mistake]
  nysalt::classical<"perfl">::coefficients();
  // [/mistake]
#endif
}
