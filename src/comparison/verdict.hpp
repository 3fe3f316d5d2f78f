// SPDX-License-Identifier: BSL-1.0
// The methods that err least at a cost, as far as error bars separate them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"

namespace nysalt::program {

/// A method at one step: its cost and its error.
struct ranked_method {
  std::string method;
  double step;                   // as typed
  double cost;                   // of a unit of time
  double error;                  // the smaller, the better; NaN: it takes part, but is not ranked
  double standard_error;         // NaN: not known
  std::vector<double> groups{};  // the part of each group of trajectories, which all methods share; or empty
};

/// The factor by which the error of `a` is larger. The standard error is that of the differences group by
/// group; without groups, of independent errors. NaN where an error is zero.
estimate error_ratio(const ranked_method& a, const ranked_method& b);

/// Whether the error of `a` is larger by more than two standard errors of the logarithm of the ratio; of
/// errors without standard errors, whether it is larger.
bool errs_more(const ranked_method& a, const ranked_method& b);

/// The methods at up to a cost, each at the step at which it errs least.
struct best_at_cost {
  double cost;
  std::vector<ranked_method>
      best;  // the least error, and those that errs_more() does not separate from it; or none
  std::optional<ranked_method> next;  // the least error of the others
  bool has_error_bars = true;         // of all that are compared
};

/// At every cost that methods have; costs that differ by less than the factor `tolerance` are one. Where two
/// methods can be afforded at some cost, ranked or not, costs at which only one can are left out.
std::vector<best_at_cost> best_at_costs(const std::vector<ranked_method>& all, double tolerance);

/// Costs of rows of one step, of which some include the evaluation of the start: each is the largest of those
/// that exceed it by no more than that evaluation, within the factor `tolerance`.
std::vector<double> without_start_up(const std::vector<double>& costs, double tolerance, double evaluation);

/// The unit of costs in force evaluations, in words.
constexpr const char* evaluations_per_time = "evaluations a unit of time";

/// One sentence, or two, on who is best at which cost; method names are between backquotes. `unit` is that of
/// the costs, in words, `error` what is compared.
std::string verdict_of(const std::vector<best_at_cost>& found, const std::string& unit,
                       const std::string& error = "error");

/// The verdict by force evaluations, and that by seconds where at the head are others, or in another order
/// from the least cost to the largest.
std::string verdict_of_both(const std::vector<best_at_cost>& by_evaluations,
                            std::vector<best_at_cost> by_seconds, const std::string& error = "error");

/// "`a`, `b` and 2 more"
std::string named(const std::vector<ranked_method>& methods);

/// Mean and standard error, to the first digit of that: 125 ± 10, 48.4 ± 0.5.
std::string with_error(const estimate& value);

}  // namespace nysalt::program
