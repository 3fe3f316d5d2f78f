// SPDX-License-Identifier: BSL-1.0
// The exact flow, as nearly as it is to be had, with its error known.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <string>

#include "nysalt/lanes.hpp"

namespace nysalt {

/// advance(system, x, t)  x becomes the state a time t later
/// finer()                the same with a much smaller error: the difference measures the error of this one
/// description()          what it is, with its step or tolerance
/// Where advance takes states over packs, it is called with them: write phase_point<double, N>& if it is for
/// one trajectory at a time.
template <class R, class S>
concept ReferenceFlow = SeparableSystem<S> &&
    requires(const R& reference, const S& system, phase_point<double, S::dimension>& x) {
  reference.advance(system, x, 1.0);
  { reference.finer() } -> std::same_as<R>;
  { reference.description() } -> std::convertible_to<std::string>;
};

namespace detail {
template <class R, class S, class T>
concept AdvancesLanes = requires(const R& reference, const S& system, phase_point<T, S::dimension>& x) {
  reference.advance(system, x, 1.0);
};
}  // namespace detail

/// The same for the trajectories in the first `count` lanes of x: all at a time if the reference can.
template <SeparableSystem S, ReferenceFlow<S> R, Scalar T>
void advance_lanes(const S& system, const R& reference, phase_point<T, S::dimension>& x, double t,
                   int count) {
  if constexpr (detail::AdvancesLanes<R, S, T>) {
    reference.advance(system, x, t);
  } else {
    for (int k = 0; k < count; ++k) {
      auto one = lane(x, k);
      reference.advance(system, one, t);
      set_lane(x, k, one);
    }
  }
}

/// Largest coordinate of the difference between a reference and its finer self after a time t from x.
template <SeparableSystem S, ReferenceFlow<S> R>
double reference_error(const S& system, const R& reference, const phase_point<double, S::dimension>& x,
                       double t) {
  auto a = x;
  auto b = x;
  reference.advance(system, a, t);
  reference.finer().advance(system, b, t);
  return std::max((a.q - b.q).cwiseAbs().maxCoeff(), (a.p - b.p).cwiseAbs().maxCoeff());
}

}  // namespace nysalt
