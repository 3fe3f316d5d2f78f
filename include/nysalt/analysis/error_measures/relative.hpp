// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <utility>

#include "nysalt/analysis/error_measures/path.hpp"

namespace nysalt {

namespace detail {
error_measure relative_measure(error_measure path);
}  // namespace detail

/// The paper's average relative error of an observable o: the mean over trajectories of sqrt(mean over times
/// of
/// ((o - o_ref)/o_ref)^2). It is for observables that keep away from 0: where o_ref is 0, or has both signs,
/// its mean does not exist, and it is refused; where o_ref comes near to 0, few trajectories decide it
/// (tail_of). The observable is copied, and called as that of path_measure. Source: [li_lu_tao_ye_2023,
/// equations (5.6-7)].
template <System S, class Observable>
error_measure relative_measure(const S& system, Observable observable) {
  return detail::relative_measure(path_measure(system, std::move(observable)));
}

}  // namespace nysalt
