// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "nysalt/ensembles/burn_in_report.hpp"

namespace nysalt {

/// Mean over independent numbers and its standard error.
discrepancy mean_over_chains(const std::vector<double>& x);

/// Chains over an interval of time.
struct watched_interval {
  double duration = 0.0;                   ///< how long it is
  double zero = 0.0;                       ///< the potential of which potentials are differences, an energy
  of_watched<std::vector<double>> begin;   ///< at its beginning, one number a chain
  of_watched<std::vector<double>> mean;    ///< over time, one a chain
  of_watched<std::vector<double>> square;  ///< mean square over time, one a chain
  std::vector<Eigen::VectorXd> force_square;  ///< mean square over time of each force, a vector a chain
  std::vector<double> way_to_begin;           ///< |q - q_0|^2 at the beginning, one a chain
  double way_to_end = 0.0;                    ///< its mean at the end

  /// A random walk doubles its variance over an interval that begins where half the time is over.
  bool confined() const { return way_to_end < 1.5 * mean_over_chains(way_to_begin).mean; }
  /// Mean potential energy of the half of the chains that have gone farther, less that of the other half.
  /// Where the motion is not confined it is 0 if the potential is the same wherever chains go, as that of
  /// angles and of a centre of mass. Where chains leave the potential behind there is no Gibbs distribution.
  discrepancy potential_of_the_far() const;
  /// Largest share of chains, over all coordinates, that met no force there while others did. A random walk
  /// along a half-line does not return within an interval that doubles its time with the probability
  /// 2/pi arcsin(1/sqrt(2)) = 1/2; along a direction that repeats itself all chains meet the same forces.
  double share_without_force() const;
  /// Whether number i is meaningful: the virial is where the motion is confined.
  bool counts(std::size_t i) const { return i != static_cast<std::size_t>(watched::virial) || confined(); }

  /// Whether the bath still cools what began at higher energies, all chains alike, which tau() does not see:
  /// the kinetic temperature, or the virial, is above that of the bath, and falls. Numbers that have
  /// overflowed do.
  bool is_cooling() const;
  /// Largest potential energy or virial at the beginning, in kT for each coordinate.
  double largest_at_begin() const;

  /// Longest of T Var(mean over T)/Var: the integrated autocorrelation time, if it is much shorter than T,
  /// and T if nothing is forgotten. Its relative error is sqrt(2/chains).
  double tau() const;
};

}  // namespace nysalt
