// SPDX-License-Identifier: BSL-1.0
// Choice of a word, and of a step, for Hybrid Monte Carlo on a system.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "json.hpp"
#include "method_file.hpp"
#include "method_source.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "prepared_problem.hpp"
#include "progress.hpp"

namespace nysalt::program {

/// A word, and the step at which its proposals are accepted as often as asked.
struct sampling_candidate {
  method_source source;
  std::optional<learn_plan> plan{};  // of what is learned: that of `learned`
  std::optional<learned_scheme> learned{};
  std::optional<acceptance_step> found{};
  std::string reason{};  // why the candidate cannot win

  bool is_learned() const { return source.family.has_value(); }
  bool is_eligible() const { return reason.empty() && found.has_value(); }
  double step_of_evaluation() const { return found->step / source.evaluations_per_step; }
};

/// Ratio of two numbers, with its standard error.
struct sampling_ratio {
  double value;
  double standard_error;
  bool is_above_one() const { return value - 2.0 * standard_error > 1.0; }
  bool is_below_one() const { return value + 2.0 * standard_error < 1.0; }
};

class sampling_choice {
 public:
  /// Plans who takes part. Throws refusal for bad options, before any work is done.
  sampling_choice(std::unique_ptr<prepared_problem> system, sampling_options asked, common_settings common);

  void learn_and_rank(const choice_observer& keep = {});

  bool has_result() const { return best_of(true) != nullptr || best_of(false) != nullptr; }
  /// The candidate to take: the best, and of a tie the one that needs no learning; null if there is none.
  const sampling_candidate* taken() const;
  /// "learned", "classical", "tie" or "none"
  std::string verdict() const;
  const std::vector<std::string>& warnings() const { return warnings_; }
  json document() const;
  std::string readable(const text_form& form = {}) const;
  static json schema();
  /// The word to take; nothing if there is none.
  std::optional<chosen_method> chosen() const;

 private:
  void require_sound_options();
  void plan_candidates();
  void consider(const std::string& name);

  void run_pilot();
  void sort_by_step();
  proposal_options proposals(std::uint64_t seed) const;
  std::optional<acceptance_step> step_of(const sampling_candidate& candidate, double guess,
                                         std::uint64_t seed, std::string& reason) const;
  /// The coefficients of a word at a step; of one that was learned, those of its own step.
  method method_at(const sampling_candidate& candidate, double step) const;
  void learn(sampling_candidate& candidate, double first_step);

  const sampling_candidate* best_of(bool learned) const;
  const sampling_candidate* named(const std::string& name) const;
  /// Steps per evaluation of one over those of another, from the same states.
  sampling_ratio ratio_of(const sampling_candidate& a, const sampling_candidate& b) const;
  std::string diagnostic() const;
  std::string advice() const;

  sampling_options options_;
  common_settings common_;
  std::unique_ptr<prepared_problem> system_;
  std::vector<sampling_candidate> all_;                        // after the work the best first
  std::vector<std::pair<std::string, std::string>> left_out_;  // name and reason
  std::optional<initial_states> states_;  // of the distribution, on which words are judged
  double guess_ = 0.0;                    // of a step per evaluation, on the safe side
  std::vector<std::string> warnings_;
  progress shown_;
};

}  // namespace nysalt::program
