// SPDX-License-Identifier: BSL-1.0
// Methods of the same cost that a fit must beat.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "problem.hpp"

namespace nysalt::detail {

/// A method that is compared by its held-out losses: a member of the family, or a classical method at the
/// step at which it costs as much per unit time.
struct contender {
  std::string name;
  std::vector<double> losses;  // of each held-out trajectory of this rank
  double loss = 0.0;           // of all
  nysalt::method method;       // word and coefficients that are judged
  double judged_step = 0.0;    // step at which they are; in a bath that of several steps as one
  Eigen::VectorXd theta{};     // of members of the family
  double step = 0.0;           // of a method that is no member; 0: that of the data
  // Of the chosen one at the times that both have, where these are not all.
  std::vector<double> losses_beside{};
  double loss_beside = 0.0;
};

/// The loss on held-out data by its times, and by the multiples of `times` steps nearest to them, made where
/// they are first asked for. Refers to the problem.
class held_out_by_times {
 public:
  explicit held_out_by_times(const learning_problem& problem);

  /// Null if the trajectories are shorter.
  const shared_loss& at_every(int times);

 private:
  const learning_problem* problem_;
  std::map<int, shared_loss> known_;
};

/// Another method at equal cost, by the loss on held-out data, with the letters O of the family's word.
/// Where its step does not divide that of the data, the loss is that at the times nearest to its own which
/// are multiples of both steps. Nothing if the system does not serve its letters, if there are no such
/// times, or if the word has letters O or a processor and the step does not divide.
std::optional<contender> rival_of(const learning_problem& problem, held_out_by_times& held_out,
                                  const method& method, const Eigen::VectorXd& theta);

/// The classical methods of any number of evaluations a step, at equal cost, that the system serves.
std::vector<contender> classical_rivals(const learning_problem& problem, const Eigen::VectorXd& theta);

/// Why a contender does not hold at its step; empty if it does.
using objection_to = std::function<std::string(const contender&)>;

/// The strongest rival, of `rivals` that hold at their steps: puts into the summary who it is, whether
/// `chosen` beats it, and who is as good by the loss and fails the trial. The share is of the held-out
/// trajectories.
void summarise_rival(const contender& chosen, std::vector<contender> rivals, const shard& share,
                     const objection_to& objection, fit_summary& summary);

}  // namespace nysalt::detail
