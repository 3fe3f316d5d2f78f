// SPDX-License-Identifier: BSL-1.0
// Which method to take for a system of one's own: learned families and classical methods at one cost or
// error.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/comparison_options.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt {

/// Result of recommend().
class recommendation {
 public:
  class contest_result;  ///< internal form of the results
  /// Made by recommend() and recommend_for_sampling().
  explicit recommendation(std::shared_ptr<const contest_result> found) : found_(std::move(found)) {}

  /// Whether a method stood.
  bool has_result() const;
  /// "learned" or "classical", whose best errs or costs less than the other by more than chance can make;
  /// "tie"; or "none".
  std::string verdict() const;
  /// The name of the method to take, for comparison_options::methods; of a tie the one that needs no
  /// learning. Empty if there is none.
  std::string method() const;
  /// The step of that method; NaN if there is none.
  double step() const;
  /// Ranking and advice, the text of the program.
  std::string text() const;
  /// A JSON document of all that was found: what `nysalt recommend --json` prints.
  std::string json() const;
  /// That method as the text of a file, for comparison_options::held: a scheme of what was learned, else a
  /// table of the coefficients at the step. Nothing if there is none.
  std::optional<std::string> method_file() const;
  /// Warnings to read before the advice is taken, a sentence each.
  std::vector<std::string> warnings() const;

 private:
  std::shared_ptr<const contest_result> found_;
};

/// The best of learned families and classical methods at options.budget, budget_seconds or error. Starts and
/// checks are the same as in compare(). Throws std::invalid_argument, naming the option, for bad input. Cost:
/// a fit for each family that suits, and a comparison of all that take part.
recommendation recommend(const initial_value_problem& problem, const recommendation_options& options,
                         const common_options& common = {});

/// The word with which Hybrid Monte Carlo takes the largest step per force evaluation on a system at one
/// acceptance: of the words that samplers ship or their literature proposes, and of families that are learned
/// for the purpose. Words are judged on states of exp(-H/kT), from pilot chains or the problem's own starts.
/// A learned word and a classical one that differ by less than two standard errors tie. Throws
/// std::invalid_argument, naming the option, for bad input. Cost: pilot chains of 500 trajectories and
/// more; some twelve times the trajectories of the options for each word; up to seven fits for each family.
recommendation recommend_for_sampling(const initial_value_problem& problem, const sampling_options& options,
                                      const common_options& common = {});

}  // namespace nysalt
