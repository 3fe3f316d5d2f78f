// SPDX-License-Identifier: BSL-1.0
// Numbers as people type them.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace nysalt::program {

/// The finite number that the whole text says; nothing if it says none.
inline std::optional<double> number_from(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace nysalt::program
