// SPDX-License-Identifier: BSL-1.0
// Recommendation of a method: learned families and classical methods at one cost, or at one error.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contest.hpp"
#include "json.hpp"
#include "method_file.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/family.hpp"
#include "prepared_problem.hpp"
#include "progress.hpp"

namespace nysalt::program {

struct method_row;

/// Starts of a search: few random ones, as many as the effort asks for, or what is known alone.
enum class start_set { few, all, known };
struct search_starts {
  start_set which = start_set::all;
  std::vector<double> known{};      // an optimum of fewer trajectories, or at another step
  std::vector<double> contained{};  // of the family that this one contains
};

class recommendation {
 public:
  /// Plans who takes part. Throws refusal for bad options, before any work is done.
  recommendation(std::unique_ptr<prepared_problem> system, recommendation_options asked,
                 common_settings common);

  void learn_and_rank(const choice_observer& keep = {});

  /// The contest at the cost or the error that was asked for, once it is ranked.
  const contest& asked() const { return by_evaluations_ ? *by_evaluations_ : *by_seconds_; }
  bool has_result() const { return asked().has_result(); }
  const std::vector<std::string>& warnings() const { return warnings_; }
  json document() const;
  std::string readable(const text_form& form = {}) const;
  static json schema();
  /// The method to take; nothing if none is accepted.
  std::optional<chosen_method> chosen() const;

 private:
  void require_sound_command();
  void plan_classical();
  void plan_families();
  void consider(candidate contender);
  bool is_fixed_in(const nysalt::family& family) const;

  // At one error.
  void rank_at_one_error();
  void race_by_seconds();
  void find_steps(const std::vector<candidate*>& all, cost_unit unit);
  /// One more step of each whose search is not over, on few trajectories or on all; false if there is none.
  bool search_on(const std::vector<candidate*>& all, bool on_few);
  static const double grid_ratio;
  double grid_step(const candidate& contender, int k) const;
  void prepare_search(candidate& contender) const;
  /// The point of the grid to try next; nothing if there is none.
  static std::optional<int> next_of(const bracket& search);
  void probe(candidate& contender, int k, std::int64_t trajectories);
  void judge(candidate& contender, int k) const;
  void step_down(candidate& contender);

  asked_metric metric() const { return {options_.metric, options_.observable}; }
  /// The fastest rate of the reference; where none is known, as without a force, one turn in the horizon.
  double rate_of_motion() const;
  trajectories_plan plan_at(double step, std::int64_t count, std::uint64_t seed) const;
  /// Determines the coefficients at the step of the contender. A family is learned from the first
  /// `trajectories` of the training set.
  void prepare(candidate& contender, std::int64_t trajectories, const search_starts& starts = {});
  std::vector<nysalt::method> formulas_at(double step) const;
  void measure(const std::vector<candidate*>& all, std::int64_t count, std::uint64_t seed);
  void measure_at(double step, const std::vector<candidate*>& group, std::int64_t count, std::uint64_t seed);
  void measure_on_test(const std::vector<candidate*>& all, std::int64_t count);

  // Seconds.
  void time_steps();
  double seconds_of_step(const candidate& contender) const {
    return step_seconds_.at(contender.source.typed).least;
  }
  /// Force evaluations of processing per unit time, where trajectories are observed as often as asked.
  double processing_of(const candidate& contender) const {
    return static_cast<double>((1 + options_.looks) * contender.source.evaluations_to_observe) /
           options_.horizon;
  }
  double seconds_of_processing(const candidate& contender) const {
    return processing_of(contender) * seconds_of_step(contender) / contender.source.evaluations_per_step;
  }
  double noise_of(const candidate& contender) const;
  double noise_of(const candidate& a, const candidate& b) const;
  contest at_equal_seconds(double seconds_per_time, const contest* known) const;

  void settle(contest& among);
  void run(contest& among);
  /// Names of what has no error yet, in the order of the work: classical methods, then families.
  static std::vector<std::vector<std::string>> parts_of(const contest& among);

  // The race: at one cost candidates fall behind by their error, at one error by their cost.
  /// Trajectories that candidates are learned from and judged on, and where the search begins.
  struct stage {
    std::int64_t learned_from;
    std::int64_t judged_on;
    start_set starts;
  };
  std::vector<stage> stages() const;
  void race(const contest& among, std::vector<candidate*> racing);
  void advance(const contest& among, candidate& contender, const stage& at);
  void leave_behind(const contest& among, std::vector<candidate*>& racing) const;
  void leave_behind_by_cost(const std::vector<candidate*>& racing, cost_unit unit) const;
  /// Whether one that was left behind is ahead of what remains, as those before it were objected to; it is
  /// learned and judged on all trajectories then.
  bool call_back(contest& among);
  bool is_ahead(const contest& among, const candidate& one, const candidate& other) const;
  void go_on(const contest& among, candidate& contender);
  /// Tells the observer of the candidate to take, if it is another than before.
  void tell_of_best();
  /// Judges one of the best on trajectories that it was not chosen on, and as `run` would warn of it.
  /// Where there is an objection, the contender takes a smaller step (at one error) or gets a reason.
  void confirm(contest& among, candidate& contender);
  void confirm_on(candidate& contender, std::int64_t trajectories);
  /// Where chance hides a factor that matters, the best of both kinds are judged on four times as many fresh
  /// trajectories; false where there is no need, or no more.
  bool confirm_on_more(contest& among);
  std::string objection_to(const candidate& contender) const;
  error_statistic statistic(bool by_quantiles) const;
  bool is_heavy(const contest& among) const;
  void warn_of_reference(const contest& among);

  std::string advice() const;
  std::string advice_of(const contest& among) const;
  std::string advice_on_seconds() const;
  std::string advice_on_observations() const;
  std::string costs(const candidate& contender, const candidate& other) const;
  std::string as_settings(const candidate& contender) const;
  std::string bound_of(const contest& among, const candidate& contender) const;
  std::string quantity() const;
  double quantile_of(const measured_error& error) const;
  method_row row_of(const contest& among, const candidate& contender) const;

  recommendation_options options_;
  common_settings common_;
  std::unique_ptr<prepared_problem> system_;
  std::vector<candidate> all_;                                 // as planned
  std::vector<std::pair<std::string, std::string>> left_out_;  // name and reason
  std::map<std::string, timed_job> step_seconds_;              // of one step of one trajectory, by name
  bool searches_by_quantiles_ = false;                         // at one error
  std::optional<contest> by_evaluations_;                      // nothing: only seconds are asked for
  std::optional<contest> by_seconds_;
  std::vector<std::string> warnings_;
  choice_observer keep_;
  std::string kept_;  // the text of the best so far
  progress shown_;
};

}  // namespace nysalt::program
