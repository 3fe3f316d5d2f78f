// SPDX-License-Identifier: BSL-1.0
// Convergence of estimators from M trajectories to one from many: the rate, with an error.
#pragma once

#include "parts.hpp"

namespace nysalt::program::paper {

/// M = 2^least .. 2^most against 2^(most + 1).
struct estimator_study {
  const prepared_problem& system;
  double step;
  learning_setup how;
  int least;
  int most;
  int repetitions;
};

/// Against an estimator from other data, and against one whose data hold those of the smaller ones.
struct estimator_errors {
  std::vector<double> trajectories;
  std::vector<estimate> from_others;  // mean over repetitions of (|b1 - ref| + |beta1 - ref|)/2
  std::vector<estimate> nested;
  estimate exponent_from_others;  // mean over repetitions of the slopes of logarithms
  estimate exponent_nested;
  estimate at_least;  // from_others at the smallest M
};
estimator_errors errors_of_estimators(const setting& setup, const estimator_study& study);

/// Finding, table and picture; the printed exponent as text and number.
exhibit exhibit_of(const estimator_errors& found, const std::string& printed, double exponent,
                   const std::string& name);

}  // namespace nysalt::program::paper
