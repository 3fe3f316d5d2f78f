// SPDX-License-Identifier: BSL-1.0
// What is learned from a wrong force is wrong, and nothing else would tell.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/learning/some_states.hpp"
#include "nysalt/sentence.hpp"

namespace nysalt {

/// check_force() at four states of the data, from the middle of each quarter of them. A system that is a
/// potential alone has nothing to check, and costs nothing, to compile either. How far these and their
/// finishes lie apart tells the lengths of coordinates. Throws std::invalid_argument with its report. The
/// data must be valid.
template <SeparableSystem S>
void require_sound_force(const S& system, const flow_map_data<S::dimension>& data) {
  if constexpr (force_may_be_wrong<S>) {
    std::vector<vector<double, S::dimension>> points;
    std::vector<vector<double, S::dimension>> momenta;
    constexpr std::size_t enough = 4;
    std::vector<std::size_t> pairs;
    for (std::size_t k = 0; k < std::min(enough, data.all_pairs()); ++k) {
      pairs.push_back(data.all_pairs() * (2 * k + 1) / (2 * enough));
    }
    for (const auto& state : starts_of(data, size(system), pairs)) {
      points.push_back(state.q);
      momenta.push_back(state.p);
    }
    const auto finishes = finishes_of(data, size(system), pairs);
    const force_check found = check_force(system, points, momenta, finishes);
    if (found.passed()) return;
    throw std::invalid_argument(sentence("learn: {} (system {}); mend it, or learn with check_force = false",
                                         found.report(), describe(system)));
  }
}

}  // namespace nysalt
