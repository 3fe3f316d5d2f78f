// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "nysalt/family.hpp"
#include "nysalt/langevin.hpp"

namespace nysalt {

/// A family in a bath: the same parameters, with letters O at a placement. Its order is that of damping
/// without noise (sigma = 0): 1 at the end, and in the middle of what is not symmetric; else 2 at most.
template <Family F, placement P>
struct thermostatted_family {
  using plain = F;  ///< family without letters O
  using word = thermostatted_word<typename F::word, P>;
  static constexpr int parameters = F::parameters;
  static constexpr auto parameter_names = F::parameter_names;
  static constexpr int order = thermostatted_order(P, F::order, F::symmetric);
  static constexpr bool symmetric = P != placement::end && F::symmetric;
  static constexpr bool requires_quadratic_kinetic = F::requires_quadratic_kinetic;

  static auto ranges() { return F::ranges(); }
  static auto start() { return F::start(); }

  template <Scalar C>
  static typename word::template coefficients<C> coefficients(
      const std::array<C, static_cast<std::size_t>(F::parameters)>& theta) {
    return thermostatted_coefficients<word>(P, F::coefficients(theta));
  }

 private:
  static constexpr std::string_view place = to_string(P);
  static constexpr auto text = [] {
    std::array<char, F::name.size() + 1 + to_string(P).size()> joined{};
    auto end = std::copy(F::name.begin(), F::name.end(), joined.begin());
    *end++ = '_';
    std::copy(place.begin(), place.end(), end);
    return joined;
  }();

 public:
  static constexpr std::string_view name{text.data(), text.size()};
};

}  // namespace nysalt
