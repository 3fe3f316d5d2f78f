// SPDX-License-Identifier: BSL-1.0
// A target without a mistake, with some branches to be followed.
#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static volatile unsigned seen = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == 'a') seen = seen + 1;
    if (data[i] == 'b' && i > 2) seen = seen + 3;
    if (data[i] > 128) seen = seen ^ 5U;
  }
  return 0;
}
