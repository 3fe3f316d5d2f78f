// SPDX-License-Identifier: BSL-1.0
// A method at a step by a metric, in the documents and tables of comparisons and recommendations.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "comparison/learned_row.hpp"
#include "comparison/measurement.hpp"

namespace nysalt::program {

/// An error on trajectories on which nothing was chosen.
struct confirmed_error {
  double error;
  double upper_bound;
};
NYSALT_DESCRIBED(confirmed_error, error, upper_bound)

/// NaN and nothing: what a command does not find of a method.
struct method_row {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::string metric{};
  std::string method{};
  double step = none;       // as typed: of a whole step, or (equal cost) of an evaluation
  double step_size = none;  // of a whole step
  double evaluations_per_time = none;
  double seconds_per_time = none;
  double seconds_per_time_median = none;
  double error = none;
  double acceptance = none;      // by the metric acceptance, in the place of an error
  double standard_error = none;  // of one of the two
  std::int64_t survivors = 0;
  std::int64_t diverged = 0;
  std::vector<diverged_trajectory> diverged_at{};
  std::vector<std::string> marks{};
  std::string reason{};  // why there is no value
  bool learned = false;
  std::optional<int> order{};
  std::optional<bool> reversible{};
  std::optional<bool> rotation{};
  std::optional<int> evaluations_per_step{};
  std::optional<double> reference_error{};
  std::optional<double> null_model{};
  std::optional<double> floor{};
  std::optional<double> predictable_until{};
  double quantile_5 = none;  // of the errors of single trajectories
  double quantile_25 = none;
  double median = none;
  double quantile_75 = none;
  double quantile_95 = none;
  double median_standard_error = none;
  double deciding = none;
  double enough_trajectories = none;
  double mean = none;  // of the observable, by a metric of distributions
  double mean_standard_error = none;
  double effective_sample_size = none;
  std::optional<double> kinetic_temperature{};
  std::optional<double> half_step_kinetic_temperature{};
  std::optional<confirmed_error> confirmed{};
  std::optional<fitted_frequency> frequency{};
  std::optional<nysalt::judgement> judgement{};
};
NYSALT_DESCRIBED(method_row, metric, method, step, step_size, evaluations_per_time, seconds_per_time,
                 seconds_per_time_median, error, acceptance, standard_error, survivors, diverged, diverged_at,
                 marks, reason, learned, order, reversible, rotation, evaluations_per_step, reference_error,
                 null_model, floor, predictable_until, quantile_5, quantile_25, median, quantile_75,
                 quantile_95, median_standard_error, deciding, enough_trajectories, mean, mean_standard_error,
                 effective_sample_size, kinetic_temperature, half_step_kinetic_temperature, confirmed,
                 frequency, judgement)

/// A method that takes no part.
struct left_out_method {
  std::string method;
  std::string reason;
};
NYSALT_DESCRIBED(left_out_method, method, reason)
inline std::vector<left_out_method> left_out_of(const std::vector<std::pair<std::string, std::string>>& all) {
  std::vector<left_out_method> result;
  for (const auto& [method, reason] : all) result.push_back({method, reason});
  return result;
}

}  // namespace nysalt::program
