// SPDX-License-Identifier: BSL-1.0
// From several starts to the best minimum that may be used.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/losses/squares.hpp"

namespace nysalt {

/// End point of a search with the score of the judge.
struct candidate {
  std::string from;                ///< name of the start
  Eigen::VectorXd theta;           ///< end point of the search
  Eigen::MatrixXd hessian;         ///< hessian of the loss at theta; empty where the guard holds it
  std::vector<Eigen::Index> free;  ///< neither fixed nor held at a bound
  double loss = std::numeric_limits<double>::infinity();    ///< the loss at theta
  double judged = std::numeric_limits<double>::infinity();  ///< score of theta by the judge; less is better
  int iterations = 0;                                       ///< iterations of all descents from this start
  bool converged = false;                                   ///< whether the search converged, see `minimum`
  bool in_valley = false;  ///< whether the search was given up in a valley of almost equal losses
  bool admitted = true;    ///< whether theta passes the guard and the trial run
  bool is_held = false;    ///< whether theta is at the boundary of the points that the guard admits
};

/// A loss that a search minimises roughly before the loss proper, to find where minima lie.
struct search_stage {
  objective loss;  ///< loss over few steps first, then over more
  int steps = 0;   ///< the last after which errors count
  /// Upper bound on the least loss found at which the search goes on: above it no member of the family
  /// follows the data for `steps` steps. Not applied where there are kept starts.
  double lost_above = std::numeric_limits<double>::infinity();
};

/// Inputs of a search.
struct search_task {
  const nysalt::family* family;          ///< family, with ranges and domain of the parameters
  objective loss;                        ///< loss to minimise
  std::vector<search_stage> stages{};    ///< losses that are minimised roughly before
  objective one_step_loss{};             ///< one-step loss, whose least minimum is a start, too; empty: none
  std::vector<named_parameters> kept{};  ///< further starts of the last stage only
  std::function<double(const Eigen::VectorXd&)> judge;  ///< score, which is least for the best theta
  theta_condition admits;                               ///< the guard
  theta_condition withstands{};                         ///< a trial run; empty: none is asked for
  /// The guard where the search goes on among admitted points only; empty: the same.
  theta_condition admits_at_edge{};
  std::vector<Eigen::Index> free;                        ///< numbers of the parameters that may change
  int max_iterations;                                    ///< largest number of iterations of each descent
  std::optional<named_parameters> most_stable_member{};  ///< a start where the guard acts
};

/// Theta normal around a start, with a deviation of .6, .3, .15 or .075 in turn, as coefficients are of order
/// one and shorter in long words: number n of a seed.
Eigen::VectorXd random_start(const nysalt::family& family, Eigen::VectorXd theta,
                             const std::vector<Eigen::Index>& free, std::uint64_t seed, std::uint64_t n);

/// The theta nearest to this one that lies in all ranges.
Eigen::VectorXd inside(const nysalt::family& family, Eigen::VectorXd theta);

/// Result of all starts. `unguarded` is the best of all where the guard did not admit it.
struct search_result {
  candidate best;                      ///< best candidate
  std::optional<candidate> unguarded;  ///< best candidate of all, if refused by guard or trial run
  int tried = 0;                       ///< number of searches
  int lost_after = 0;                  ///< steps of the stage at which the search was given up; 0: it was not
};

/// Searches from all starts. Where there are stages, the loss of each of them in turn is minimised, roughly,
/// from the starts first and then from the best of its minima that differ, twelve and then three, those first
/// that the guard admits. A search whose minima of a stage are all above what that stage bears ends there.
/// With what is left the search proper begins, and with two of the minima of the one-step loss that twelve of
/// the first stage lead to, the least and that of the least loss: valleys of trajectories at small steps are
/// narrow. From each start to its minimum; the judge takes the best that the guard admits and that withstands
/// a trial run, of those that converged or ended in a valley. Where there is none, or where it errs by more
/// than twice what one does that is not admitted, or by more than a kept start, the search goes on among
/// admitted points only, from the starts that are and from the most stable member: what it finds lies at the
/// edge mostly, and the judge decides. A single start is what it was, for any judge. Cost: a search for each
/// start, twice where the guard acts, and a trial run for each of a few candidates.
search_result search(const search_task& task, const std::vector<named_parameters>& starts);

}  // namespace nysalt
