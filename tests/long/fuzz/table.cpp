// SPDX-License-Identifier: BSL-1.0
// Tables of coefficients that people wrote.
#include <cstddef>
#include <cstdint>

#include "method_files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nysalt::fuzz::try_method_file({reinterpret_cast<const char*>(data), size});
  return 0;
}
