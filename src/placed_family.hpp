// SPDX-License-Identifier: BSL-1.0
// A family as `learn` takes it: in a bath or not, one type for all placements of O.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/langevin.hpp"

namespace nysalt::program {

/// Parameters, bounds and promises are those of F, coefficients those with O where it is placed.
template <Family F>
  requires TypeLevelWord<typename F::word>
class placed_family {
 public:
  using word = run_time_word;
  static constexpr std::string_view name = F::name;
  static constexpr int parameters = F::parameters;
  static constexpr auto parameter_names = F::parameter_names;
  static constexpr int order = F::order;
  static constexpr bool symmetric = F::symmetric;
  static constexpr bool requires_quadratic_kinetic = F::requires_quadratic_kinetic;

  explicit placed_family(std::optional<placement> where = {}) : where_(where) {}

  static auto ranges() { return F::ranges(); }
  static auto start() { return F::start(); }

  run_time_word letters() const {
    const run_time_word plain{typename F::word{}};
    return where_ ? thermostatted(plain, *where_) : plain;
  }

  template <Scalar C>
  std::vector<C> coefficients(const std::array<C, static_cast<std::size_t>(F::parameters)>& theta) const {
    const auto plain = F::coefficients(theta);
    if (!where_) return {plain.begin(), plain.end()};
    return thermostatted_coefficients(run_time_word(typename F::word{}), *where_,
                                      std::vector<C>(plain.begin(), plain.end()));
  }

 private:
  std::optional<placement> where_;
};

}  // namespace nysalt::program
