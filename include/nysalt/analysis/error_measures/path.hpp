// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <concepts>
#include <span>
#include <utility>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// A function of a state over T.
template <class F, class T, int N>
concept IsObservable = requires(const F& f, const phase_point<T, N>& x) {
  { f(x) } -> std::convertible_to<T>;
};

/// The paper's average relative error of an observable o [li_lu_tao_ye_2023, equations (5.6-7)]: the mean
/// over trajectories of sqrt(mean over times of ((o - o_ref)/o_ref)^2). The observable is copied, and called
/// as observable(x) for one trajectory after the other, or for all lanes at a time if it is marked by
/// over_lanes. There is no such error where o_ref is 0.
// clang-format off
template <System S, class Observable>
  requires(IsObservable<Observable, double, S::dimension> ||
           IsObservable<Observable, scalar_of_lanes<lanes_of<S>>, S::dimension>)
error_measure<S::dimension, lanes_of<S>> path_measure(const S&, Observable observable) {
  // clang-format on
  using T = scalar_of_lanes<lanes_of<S>>;
  using numbers = std::span<const T>;
  const auto read = [observable = std::move(observable)](const auto& x, std::span<T> result) {
    result[0] = value_in_lanes<T>(observable, x);
  };
  const auto error = [](numbers seen, numbers expected) {
    const T difference = seen[0] - expected[0];
    return difference * difference / (expected[0] * expected[0]);
  };
  const auto scale = [](numbers expected) { return expected[0]; };
  return {"path",
          1,
          read,
          error,
          averaging::root_of_each,
          true,
          scale,
          "the path error is relative to the observable on the reference, which is 0 somewhere; take another "
          "observable, or measure states"};
}

}  // namespace nysalt
