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
  std::function<bool()> withstands{};
  Eigen::VectorXd theta{};  // of members of the family
};

/// Whether the loss of a is smaller than that of b by two standard errors of their difference, and by more
/// than rounding: losses below 1e-24 are errors of 1e-12 of an increment.
bool is_better(const contender& a, const contender& b, const shard& share);

/// The strongest rival of the same cost, of `rivals` and the classical methods that hold at the step:
/// puts into the summary who it is, and whether `chosen` beats it.
void summarise_rival(const learning_problem& problem, const contender& chosen, std::vector<contender> rivals,
                     fit_summary& summary);

}  // namespace nysalt::detail
