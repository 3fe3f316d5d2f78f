// expect: nysalt: fine paths need a method with one letter O
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_paths.hpp"

int main() {
#ifdef NYSALT_CONTROL
  nysalt::fine_paths(0.1, nysalt::aboba());
#else
  // [mistake]
  nysalt::fine_paths(0.1, nysalt::obabo());
  // [/mistake]
#endif
}
