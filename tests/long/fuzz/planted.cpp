// SPDX-License-Identifier: BSL-1.0
// A target with some branches to be followed and, with PLANTED, a mistake: it aborts on most inputs, though
// not on those of its corpus, which are of one letter each.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static volatile unsigned seen = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == 'a') seen = seen + 1;
    if (data[i] == 'b' && i > 2) seen = seen + 3;
#ifdef PLANTED
    if (data[i] != data[0]) std::abort();
#endif
  }
  return 0;
}
