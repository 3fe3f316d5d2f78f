// SPDX-License-Identifier: BSL-1.0
// A target with a mistake: it aborts on most inputs, though not on those of its corpus, which are of one
// letter each.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (std::size_t i = 1; i < size; ++i) {
    if (data[i] != data[0]) std::abort();
  }
  return 0;
}
