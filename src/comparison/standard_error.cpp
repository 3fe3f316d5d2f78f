// SPDX-License-Identifier: BSL-1.0
#include "standard_error.hpp"

#include <cstdio>

namespace nysalt::program {

void to_standard_error(std::string_view text) noexcept {
  [[maybe_unused]] const auto written = std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  std::clearerr(stderr);
}

}  // namespace nysalt::program
