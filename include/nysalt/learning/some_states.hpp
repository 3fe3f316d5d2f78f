// SPDX-License-Identifier: BSL-1.0
// A few states of data, wherever they are.
#pragma once

#include <cstddef>
#include <vector>

#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// First states of some pairs of all ranks, by rising numbers; the same list on each rank.
phase_points starts_of(const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs);
/// Last states of these pairs.
phase_points finishes_of(const flow_map_data& data, Eigen::Index dimension,
                         const std::vector<std::size_t>& pairs);

/// States of data, at all ranks.
struct states_of_data {
  phase_points states;  ///< typical ones, then such as are likely to be extreme
  std::size_t typical;  ///< number of the former
};

/// Starts of some hundred pairs, spread over all; then of 32 more where the force changes most, and the
/// further starts. Cost: two evaluations a pair.
states_of_data some_states(const model& system, const flow_map_data& data);

/// Starts to judge methods on: those of the data, or if they have none up to 512 states of held-out data.
phase_points judged_starts_of(const model& system, const flow_map_data& data, const flow_map_data& held_out);

}  // namespace nysalt
