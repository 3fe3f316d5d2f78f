// SPDX-License-Identifier: BSL-1.0
// Data of two seeds, and what is learned from them; the parts of the library that such tests need.
#pragma once

#include <string>
#include <string_view>

#include "losses.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

namespace nysalt::test {

/// Data to learn from, and held-out data: the same with the next seed.
struct data_sets {
  data_sets(const auto& system, const auto& law, const auto& reference, data_options options)
      : data(make_flow_map_data(system, law, reference, options)) {
    ++options.seed;
    held_out = make_flow_map_data(system, law, reference, options);
  }
  data_sets(flow_map_data learned_from, flow_map_data judged_by)
      : data(std::move(learned_from)), held_out(std::move(judged_by)) {}

  /// What learn() makes of them.
  template <SeparableSystem S, class... Own>
  fit learned(const nysalt::family& family, const S& system, const fit_options& options = {},
              const own_loss<Own>&... own) const {
    return learn(family, system, data, held_out, options, own...);
  }

  flow_map_data data, held_out;
};

inline bool says(const std::string& text, std::string_view words) {
  return text.find(words) != std::string::npos;
}

/// Starts about the state at rest at the origin.
template <int N>
normal_around<N> around_rest(double of_q, double of_p, Eigen::Index size = N) {
  const vector<double, N> zero = Eigen::VectorXd::Zero(size);
  return {{zero, zero}, of_q, of_p};
}

}  // namespace nysalt::test
