// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "nysalt/family.hpp"

namespace nysalt {

/// Defaults of a family: parameters theta1, theta2, ... between -4 and 4; of order 1,
/// not symmetric, for any kinetic energy. A family of one's own adds
///   using word = ...;  static constexpr std::string_view name = ...;  start();  coefficients(theta)
template <int Parameters>
struct composition {
  static constexpr int parameters = Parameters;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;

 private:
  static constexpr auto count = static_cast<std::size_t>(Parameters);
  static constexpr std::array<std::string_view, 12> numbered{"theta1", "theta2",  "theta3",  "theta4",
                                                             "theta5", "theta6",  "theta7",  "theta8",
                                                             "theta9", "theta10", "theta11", "theta12"};

 public:
  static constexpr std::array<std::string_view, count> parameter_names = [] {
    static_assert(count <= numbered.size(), "nysalt: name the parameters of so large a family");
    std::array<std::string_view, count> first;
    for (std::size_t k = 0; k < count; ++k) first[k] = numbered[k];
    return first;
  }();

  static std::array<parameter_range, count> ranges() {
    std::array<parameter_range, count> all;
    all.fill({-farthest_parameter, farthest_parameter, false});
    return all;
  }
};

/// The names a1, b1, a2, b2, ... of coefficients that are parameters, in the order of the word; b first where
/// the word begins with it.
template <std::size_t Count>
constexpr std::array<std::string_view, Count> names_in_turn(bool b_is_first) {
  constexpr std::array<std::string_view, 6> a{"a1", "a2", "a3", "a4", "a5", "a6"};
  constexpr std::array<std::string_view, 6> b{"b1", "b2", "b3", "b4", "b5", "b6"};
  static_assert(Count <= 12, "nysalt: name the parameters of so large a family");
  std::array<std::string_view, Count> all;
  for (std::size_t k = 0; k < Count; ++k) all[k] = ((k % 2 == 0) != b_is_first ? a : b)[k / 2];
  return all;
}

}  // namespace nysalt
