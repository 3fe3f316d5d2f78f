// SPDX-License-Identifier: BSL-1.0
// When a trajectory has run away.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "nysalt/bath.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

/// Steps between two checks: an energy costs about a force, 2 % of this number of steps of a one-stage
/// method.
inline constexpr std::int64_t steps_between_checks = 64;

/// One that ran away, and the first bad step that was seen.
struct diverged_trajectory {
  std::int64_t trajectory = 0;  ///< its number in the ensemble
  std::int64_t step = 0;        ///< the first bad one
};

namespace detail {

/// Detects divergence: not finite, or |H - H_0| > 1e3 max(|H_0|, K_0, |q grad V|, N kT) with the values at
/// the start, energies that do not vanish together where H_0 does by chance. Without an energy only the
/// first, and likewise where these are all 0, and in a bath that heats without end (noise, but no friction).
/// Over packs lane by lane.
template <System S, Scalar T = double>
class divergence {
 public:
  using state = phase_point<T, S::dimension>;  ///< over double, or over packs

  /// For trajectories that begin at `start`, where H_0 is taken. Refers to the system. Cost: three energies,
  /// where there is one.
  divergence(const S& system, const state& start) : system_(&system) {
    if constexpr (HasEnergy<S>) {
      if (!has_energy(system)) return;
      initial_ = energy_in_lanes<T>(system, start);
      state at_rest = start;
      for (T& p : at_rest.p) p = T(0.0);
      const T potential = energy_in_lanes<T>(system, at_rest);
      constexpr double further = 0x1p-10;
      for (T& q : at_rest.q) q = q * (1.0 + further);
      const T slope = magnitude(energy_in_lanes<T>(system, at_rest) - potential) * (1.0 / further);
      T size = magnitude(initial_);
      for (const T& other : {magnitude(initial_ - potential), slope, T(energy_of_bath(system))}) {
        size = select(other > size, other, size);
      }
      constexpr double infinity = std::numeric_limits<double>::infinity();
      most_ = 1e3 * select(size > 0.0, size, T(infinity));
    }
  }

  /// The largest |H - H_0| that is no divergence.
  const T& largest_change() const { return most_; }

  /// |H - H_0| of the state that was checked last; 0 without an energy.
  const T& last_change() const { return last_; }

  /// Whether x has run away: a bool, or a mask of lanes. Cost: one energy.
  detail::condition_of<T> operator()(const state& x) {
    detail::condition_of<T> sound = is_finite(x);
    if constexpr (HasEnergy<S>) {
      if (has_energy(*system_)) {
        const T change = energy_in_lanes<T>(*system_, x) - initial_;
        sound = both(sound, both(change <= most_, change >= -most_));
        last_ = magnitude(change);
      }
    }
    return !sound;
  }

 private:
  static double energy_of_bath(const S& system) {
    if constexpr (HasBath<S>) {
      const bath& heat_bath = system.bath();
      if (!heat_bath.acts()) return 0.0;
      if (!heat_bath.has_temperature()) return std::numeric_limits<double>::infinity();
      return heat_bath.temperature() * static_cast<double>(size(system));
    }
    return 0.0;
  }
  static T magnitude(const T& x) {
    using std::abs;
    return abs(x);
  }
  const S* system_;
  T initial_{};
  T most_{};
  T last_{};
};

}  // namespace detail

}  // namespace nysalt
