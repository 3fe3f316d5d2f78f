// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// The paper's average relative error of an observable o [li_lu_tao_ye_2023, equations (5.6-7)]: the mean
/// over trajectories of sqrt(mean over times of ((o - o_ref)/o_ref)^2). The observable is copied, and called
/// as observable(x). Throws std::invalid_argument, when used, where o_ref is 0.
template <System S, class Observable>
  requires std::is_invocable_r_v < double, const Observable&, const phase_point<double, S::dimension>
& > error_measure<S::dimension> path_measure(const S&, Observable observable) {
  using numbers = std::span<const double>;
  const auto read = [observable = std::move(observable)](const auto& x, std::span<double> result) {
    result[0] = observable(x);
  };
  const auto error = [](numbers seen, numbers expected, numbers) {
    const double o = seen[0];
    const double o_ref = expected[0];
    if (o_ref == 0.0) {
      throw std::invalid_argument(
          "the path error is relative to the observable on the reference, which is 0 somewhere; take another "
          "observable, or measure states");
    }
    return (o - o_ref) * (o - o_ref) / (o_ref * o_ref);
  };
  return {"path", 1, read, error, averaging::root_of_each};
}

}  // namespace nysalt
