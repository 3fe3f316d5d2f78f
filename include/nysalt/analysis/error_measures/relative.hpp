// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <span>
#include <utility>

#include "nysalt/analysis/error_measures/path.hpp"

namespace nysalt {

/// The paper's average relative error of an observable o: the mean over trajectories of sqrt(mean over times
/// of
/// ((o - o_ref)/o_ref)^2). It is for observables that keep away from 0: where o_ref is 0, or has both signs,
/// its mean does not exist, and it is refused; where o_ref comes near to 0, few trajectories decide it
/// (tail_of). The observable is copied, and called as that of path_measure. Source: [li_lu_tao_ye_2023,
/// equations (5.6-7)].
template <System S, class Observable>
error_measure<S::dimension, lanes_of<S>> relative_measure(const S& system, Observable observable) {
  using T = scalar_of_lanes<lanes_of<S>>;
  using numbers = std::span<const T>;
  auto result = path_measure(system, std::move(observable));
  result.name = "relative";
  result.error = [](numbers seen, numbers expected) {
    const T difference = seen[0] - expected[0];
    return difference * difference / (expected[0] * expected[0]);
  };
  result.scale = [](numbers expected) { return expected[0]; };
  result.relative_to = {};
  result.no_scale =
      "the relative error divides by the observable on the reference, which is 0 or changes its sign; take "
      "the path error, or another observable";
  return result;
}

}  // namespace nysalt
