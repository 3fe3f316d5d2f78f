// SPDX-License-Identifier: BSL-1.0
// Numbers as people type them: in decimal, whole texts, never wrapped or cut.
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "refusal.hpp"

namespace nysalt::program {

/// The finite number that the whole text says; nothing if it says none.
inline std::optional<double> number_from(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The number that an option's text says. Throws refusal if that is none, or none of the kind T.
template <class T>
T number_of(const std::string& option, std::string_view text) {
  if constexpr (std::is_floating_point_v<T>) {
    const auto value = number_from(text);
    if (!value) refuse("{} must be a finite number, got '{}'", option, text);
    return *value;
  } else {
    T value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) {
      refuse("{} must be a whole number from {} to {}, got {}", option, std::numeric_limits<T>::min(),
             std::numeric_limits<T>::max(), text);
    }
    if (error == std::errc{} && end == text.data() + text.size()) return value;
    refuse("{} must be a whole number{}, got '{}'", option, std::is_unsigned_v<T> ? " from 0 on" : "", text);
  }
}

}  // namespace nysalt::program
