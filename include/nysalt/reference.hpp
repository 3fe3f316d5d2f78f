// SPDX-License-Identifier: BSL-1.0
// Accurate reference flows with a measured error.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>

#include "nysalt/bath.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// A flow that is as good as exact, of a system that is in no bath:
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

/// Trajectory and position of the noise of a path: after `step` intervals of equal length.
struct path_place {
  std::uint64_t seed = 0;        ///< seed of the noise
  std::uint64_t trajectory = 0;  ///< trajectory number of the noise
  std::int64_t step = 0;         ///< number of preceding intervals of that length
};

/// A reference for a system in a bath, path by path:
/// advance(system, x, t, place, xi)  x becomes the state a time t later on that path, over double and packs;
///                                   xi, a span, are given the noise of as many equal parts of t
/// finer()                           the same path in half the step (error_over_difference)
/// description()
template <class R, class S>
concept PathReference = HasBath<S> && SeparableSystem<S> &&
                        requires(const R& reference, const S& system, phase_point<double, S::dimension>& x,
                                 std::span<vector<double, S::dimension>> xi) {
                          reference.advance(system, x, 1.0, path_place{}, xi);
                          { reference.finer() } -> std::same_as<R>;
                          { reference.description() } -> std::convertible_to<std::string>;
                        };

/// The error of a path in small steps, over its difference from the same path in half the step: 4/3 of order
/// two, which BAOAB has where friction is weak, and sqrt(4/3) = 1.15 where noise makes the errors of
/// successive halvings independent; 1.33 at friction .01 and 1.20 to 1.24 at 1 are measured against a 64th of
/// the step (tests/references/fine_paths_test.cpp). The larger of both: an error is not estimated too small.
inline constexpr double error_over_difference = 4.0 / 3.0;

/// Either: what data and errors can come from.
template <class R, class S>
concept Reference = ReferenceFlow<R, S> || PathReference<R, S>;

namespace detail {
template <class R, class S, class T>
concept AdvancesLanes = requires(const R& reference, const S& system, phase_point<T, S::dimension>& x) {
  reference.advance(system, x, 1.0);
};
}  // namespace detail

/// Advances the trajectories in the first `count` lanes of x: all at a time if the reference can.
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

/// Advances the lanes by any reference; a flow has no noise, and leaves xi unchanged.
template <SeparableSystem S, Reference<S> R, Scalar T>
void advance_lanes(const S& system, const R& reference, phase_point<T, S::dimension>& x, double t, int count,
                   const path_place& at, std::span<vector<T, S::dimension>> xi) {
  if constexpr (PathReference<R, S>) {
    reference.advance(system, x, t, at, xi);
  } else {
    advance_lanes(system, reference, x, t, count);
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
