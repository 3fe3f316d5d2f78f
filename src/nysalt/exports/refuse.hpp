// SPDX-License-Identifier: BSL-1.0
// Refusals of exports, in one line.
#pragma once

#include <fmt/format.h>

#include <stdexcept>

namespace nysalt::detail {

/// Throws std::invalid_argument with the formatted message.
template <class... A>
[[noreturn]] void refuse_export(fmt::format_string<A...> text, A&&... values) {
  throw std::invalid_argument(fmt::format(text, std::forward<A>(values)...));
}

}  // namespace nysalt::detail
