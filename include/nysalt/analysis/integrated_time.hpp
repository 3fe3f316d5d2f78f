// SPDX-License-Identifier: BSL-1.0
// Integrated autocorrelation time: the number of samples that count for one.
#pragma once

#include <cstddef>
#include <span>

namespace nysalt {

/// Integrated autocorrelation time in units of the interval between samples.
struct integrated_time {
  double tau = 1.0;        ///< 1 + 2 sum_{k=1..W} rho(k): that number of samples counts for one in a mean
  double memory = 1.0;     ///< 1 + 2 sum_{k=1..W} |rho(k)|: how long an oscillating observable remembers
  std::size_t window = 0;  ///< W
  bool enough = false;     ///< false: the lags end before the window does, or noise outweighs tau
};

/// Integrated autocorrelation time from rho(0..L), rho(0) = 1, with Sokal's self-consistent window
/// [sokal_1997]: the smallest W >= 5 memory(W) (10 of his times, which are half of ours; the rest of an
/// exponential is then below 1e-4). The window asks memory, which for rho >= 0 is tau: tau itself dips where
/// rho oscillates, and the window would close there. Without enough lags tau and memory are what all of them
/// add up to. A burn-in follows from memory. Throws std::invalid_argument if there is no lag.
integrated_time integrated_autocorrelation_time(std::span<const double> rho);

/// The independent samples that would give a mean the error of `samples` samples along a trajectory,
/// samples/tau; NaN where the lags were not enough. Of tau measured on these samples the standard error is
/// about tau sqrt((4 W + 2)/samples) [sokal_1997]. tau counts as two such errors at least, with memory in
/// place of tau: an estimate that noise makes too small would make the error of the mean too small.
double effective_sample_size(double samples, const integrated_time& time);

}  // namespace nysalt
