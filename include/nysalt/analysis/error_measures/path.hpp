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

/// The error of an observable o along the path: the mean over trajectories of sqrt(mean over times of
/// (o - o_ref)^2), over the root mean square of o_ref over trajectories and times, which is the same for all:
/// o may pass through 0. The observable is copied, and called as observable(x) for one trajectory after the
/// other, or for all lanes at a time if it is marked by over_lanes. There is no such error where o_ref is 0
/// on all trajectories at all times.
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
    return difference * difference;
  };
  const auto square = [](numbers expected) { return expected[0] * expected[0]; };
  return {.name = "path",
          .width = 1,
          .read = read,
          .error = error,
          .how = averaging::root_of_each,
          .no_scale =
              "the path error is relative to the observable on the reference, which is 0; take another "
              "observable, or measure states",
          .relative_to = square};
}

}  // namespace nysalt
