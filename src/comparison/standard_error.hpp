// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string_view>

namespace nysalt::program {

/// Writes to standard error, and nothing happens where that is closed, full or a broken pipe.
void to_standard_error(std::string_view text) noexcept;

}  // namespace nysalt::program
