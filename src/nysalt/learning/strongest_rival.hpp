// SPDX-License-Identifier: BSL-1.0
// Methods of the same cost that a fit must beat.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "nysalt/learning/problem.hpp"

namespace nysalt::detail {

/// A method that is compared by its held-out losses.
struct contender {
  std::string name;
  std::vector<double> losses;  // of each held-out trajectory of this rank
  double loss = 0.0;           // of all
  /// Why it does not hold at its step; empty if it does.
  std::function<std::string()> objection{};
  Eigen::VectorXd theta{};  // of members of the family
  double step = 0.0;        // of a method that is no member; 0: that of the data
  // Of the chosen one at the times that both have, where these are not all.
  std::vector<double> losses_beside{};
  double loss_beside = 0.0;

  bool withstands() const { return objection().empty(); }
};

/// See is_better() of losses.
bool is_better(const contender& a, const contender& b, const shard& share);

/// The strongest rival of the same cost per unit time, of `rivals` and the classical methods of any number of
/// evaluations a step that hold at their steps: puts into the summary who it is, whether `chosen` beats it,
/// and who is as good by the loss and fails the trial.
void summarise_rival(const learning_problem& problem, const contender& chosen, std::vector<contender> rivals,
                     fit_summary& summary);

}  // namespace nysalt::detail
