// SPDX-License-Identifier: BSL-1.0
// From a system, its data and a family to a problem that knows none of their types.
#pragma once

#include <concepts>
#include <optional>
#include <string>

#include "nysalt/learning/fit.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/losses/window_error.hpp"

namespace nysalt {

namespace detail {

/// A loss other than those of losses(), over the scalar that carries the windows.
struct other_loss {
  std::string name;
  std::string description;
  int steps;
  std::optional<window_error<lanes>> in_lanes = {};
  std::optional<window_error<double>> one_by_one = {};
};

template <SeparableSystem S, class Error>
other_loss without_type(const S& system, const own_loss<Error>& own) {
  other_loss result{own.name, own.description(), own.steps};
  if constexpr (std::same_as<scalar_of_passes<S>, lanes>) {
    result.in_lanes = own_error(system, own.error);
  } else {
    result.one_by_one = own_error(system, own.error);
  }
  return result;
}

learning_problem make_learning_problem(const run_time_family& family, const model& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const other_loss* other = nullptr);

fit learn(const run_time_family& family, const model& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options, const other_loss* other = nullptr);

}  // namespace detail

/// The problem of fitting the family's word to the data: by the loss of the options, or by one own_loss.
/// Throws what learn() does.
template <SeparableSystem S, class... Own>
  requires(sizeof...(Own) <= 1)
learning_problem make_learning_problem(const run_time_family& family, const S& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const own_loss<Own>&... own) {
  if constexpr (sizeof...(Own) == 0) {
    return detail::make_learning_problem(family, system, data, held_out, options);
  } else {
    const auto other = detail::without_type(system, own...);
    return detail::make_learning_problem(family, system, data, held_out, options, &other);
  }
}

}  // namespace nysalt
