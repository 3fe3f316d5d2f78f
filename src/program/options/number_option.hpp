// SPDX-License-Identifier: BSL-1.0
// An option that takes a number.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "comparison/number.hpp"

namespace nysalt::program {

template <class T>
struct plain {
  using type = T;
};
template <class T>
struct plain<std::optional<T>> {
  using type = T;
};

/// Read here, as CLI11 takes an empty text for 0, 010 for 8, and a number that is too large for the largest.
template <class T>
CLI::Option* add_number(CLI::App& command, const std::string& name, T& value, const std::string& what) {
  using number = typename plain<T>::type;
  const auto take = [name, &value](const CLI::results_t& texts) {
    value = number_of<number>(name, texts.back());
    return true;
  };
  CLI::Option* option = command.add_option(name, take, what);
  option->type_name(std::is_floating_point_v<number> ? "X" : "N");
  if constexpr (std::is_same_v<T, number>) option->default_str(fmt::format("{}", value));
  return option;
}

}  // namespace nysalt::program
