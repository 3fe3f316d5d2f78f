// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <vector>

#include "nysalt/ensembles/burn_in_report.hpp"

namespace nysalt {

/// Mean over independent numbers and its standard error.
discrepancy mean_over_chains(const std::vector<double>& x);

/// Chains over an interval of time.
struct watched_interval {
  double duration = 0.0;                   ///< how long it is
  of_watched<std::vector<double>> begin;   ///< at its beginning, one number a chain
  of_watched<std::vector<double>> mean;    ///< over time, one a chain
  of_watched<std::vector<double>> square;  ///< mean square over time, one a chain
  double way_to_begin = 0.0;               ///< mean of |q - q_0|^2 over chains, at the beginning
  double way_to_end = 0.0;                 ///< the same at the end

  /// A random walk doubles its variance over an interval that begins where half the time is over.
  bool confined() const { return way_to_end < 1.5 * way_to_begin; }
  /// Whether number i is meaningful: the virial is where the motion is confined.
  bool counts(std::size_t i) const { return i != static_cast<std::size_t>(watched::virial) || confined(); }

  /// Longest of T Var(mean over T)/Var: the integrated autocorrelation time, if it is much shorter than T,
  /// and T if nothing is forgotten. Its relative error is sqrt(2/chains).
  double tau() const;
};

}  // namespace nysalt
