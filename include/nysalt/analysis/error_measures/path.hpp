// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <concepts>
#include <utility>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// A function of a state over T.
template <class F, class T, int N>
concept IsObservable = requires(const F& f, const phase_point<T, N>& x) {
  { f(x) } -> std::convertible_to<T>;
};

namespace detail {

/// An observable of states of N coordinates, of states whose dimension is known at run time.
template <int N, class Observable>
struct observable_of_any_dimension {
  Observable observable;

  template <class T>
  T operator()(const phase_point<T, Eigen::Dynamic>& x) const {
    return value_in_lanes<T>(observable, of_dimension<N>(x));
  }
};

error_measure path_measure(const over_scalars<of_state>& observable, Eigen::Index dimension);

}  // namespace detail

/// The error of an observable o along the path: the mean over trajectories of sqrt(mean over times of
/// (o - o_ref)^2), over the root mean square of o_ref over trajectories and times, which is the same for all:
/// o may pass through 0. The observable is copied, and called as observable(x) for one trajectory after the
/// other, or for all lanes at a time if it is marked by over_lanes. There is no such error where o_ref is 0
/// on all trajectories at all times.
template <System S, class Observable>
  requires IsObservable<Observable, double, S::dimension>
error_measure path_measure(const S& system, Observable observable) {
  const detail::observable_of_any_dimension<S::dimension, Observable> of_any{std::move(observable)};
  return detail::path_measure(of_any, size(system));
}

}  // namespace nysalt
