// SPDX-License-Identifier: BSL-1.0
// Options and report of a burn-in.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace nysalt {

/// 0 is for what is to be found.
struct burn_in_options {
  double friction =
      0.0;            ///< friction of the chains; 0: the one of four with the shortest autocorrelation time
  double step = 0.0;  ///< initial step; 0: omega h = 1/2 at the highest frequency, declared or at the starts
  double length = 0.0;  ///< a time; 0: 20 times the longest autocorrelation time, or more from hot starts
  int pilots = 256;     ///< number of chains that are measured
  std::int64_t most_steps = 10'000'000;  ///< largest number of steps of a pilot until it is stationary
  std::uint64_t seed = 1;                ///< seed of the pilots
  int threads = 1;                       ///< threads for the pilots; changes no bit
};

/// The observed quantities, all in units of kT: the kinetic temperature between two steps, the virial
/// -sum_i q_i f_i / N, whose mean is 1 where the motion is confined, V/N, and the energy of the slowest mode
/// where it is known (slowest_mode.hpp), else 0.
enum class watched : std::uint8_t { kinetic, virial, potential, slowest };
inline constexpr std::size_t watched_numbers = 4;  ///< number of watched observables
/// Names of the observed quantities in messages.
inline constexpr std::array watched_names = {"half-step kinetic temperature", "virial", "potential energy",
                                             "energy of the slowest mode"};

/// Values, one for each watched observable, in the order of `watched`.
template <class T>
using of_watched = std::array<T, watched_numbers>;

/// A mean over independent chains whose expectation is 0, and its standard error.
struct discrepancy {
  double mean = 0.0;            ///< mean over chains
  double standard_error = 0.0;  ///< standard error of that mean
  /// Whether the mean is significant: 4.5 standard errors, which chance exceeds once in 150'000 times. One
  /// whose numbers have overflowed is.
  bool shows() const { return !(std::abs(mean) <= 4.5 * standard_error && std::isfinite(standard_error)); }
};

/// Length and parameters of a burn-in, and what the pilots showed.
struct burn_in_report {
  double friction = 0.0;   ///< friction of the chains; the distribution of q does not depend on it
  double step = 0.0;       ///< h of BAOAB
  std::int64_t steps = 0;  ///< steps of every chain
  double length = 0.0;     ///< steps * step
  /// Longest integrated autocorrelation time, 2 int_0^inf rho(t) dt, of what is watched.
  double tau = 0.0;
  bool confined = false;                ///< whether the motion is confined; else the virial means nothing
  int halvings = 0;                     ///< halvings of the first step until no bias showed
  of_watched<discrepancy> bias = {};    ///< means with this step, less those with half of it
  of_watched<discrepancy> excess = {};  ///< mean at the end of the burn-in, less the value of equipartition
  of_watched<discrepancy> to_forget =
      {};                ///< mean at the end of the burn-in, less that in an equally long time after it
  double seconds = 0.0;  ///< wall time that finding this took

  /// Entry of bias, excess or to_forget.
  const discrepancy& of(const of_watched<discrepancy>& all, watched what) const {
    return all[static_cast<std::size_t>(what)];
  }
};

}  // namespace nysalt
