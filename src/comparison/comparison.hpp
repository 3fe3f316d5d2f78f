// SPDX-License-Identifier: BSL-1.0
// Methods beside each other: which at which step, how far they err by each metric, and what they cost.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "asked_metric.hpp"
#include "json.hpp"
#include "learned_row.hpp"
#include "measurement.hpp"
#include "method_source.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "prepared_problem.hpp"
#include "progress.hpp"
#include "work_file.hpp"

namespace nysalt::program {

/// One method at one step.
struct row {
  std::string method;  // as typed
  double nominal;      // the step as typed: of a whole step, or (equal cost) of an evaluation
  double step;         // that is taken
  bool is_learned = false;
  bool gains_nothing = false;  // learned, and a classical method of its cost is as good by the loss
  std::optional<nysalt::method> coefficients{};
  std::optional<fitted_frequency> frequency{};  // of coefficients that follow from one
  std::string reason{};                         // why the method could not be used
  double share_of_evaluation = 1.0;   // what an evaluation costs on average, of one of the whole force
  double evaluations_per_time = 0.0;  // at their prices
  timed_job seconds_per_time{};
  std::vector<measurement> measurements{};  // by each metric
  std::optional<judgement> judged{};        // at the step; nothing where it was not used
  std::optional<energy_course> energies{};
};

/// Throws refusal for an option of a metric that is not asked for, where it is given: by the field, such as
/// `observable`.
void require_fitting(const comparison_options& asked, const std::function<bool(const char*)>& is_given);

/// Plans, learns and measures. Each part that is finished goes into a work file; what is there is not done
/// again.
class comparison {
 public:
  /// Plans the rows. Throws refusal for bad options, before any work is done.
  comparison(std::unique_ptr<prepared_problem> system, comparison_options asked, common_settings common);

  /// The question, without how it is computed: two comparisons of one question have the same results to the
  /// bit.
  const json& question() const { return question_; }
  void learn_and_measure(work_file& kept);

  const comparison_options& options() const { return options_; }
  const common_settings& common() const { return common_; }
  /// Of each trajectory.
  double horizon() const { return horizon_; }
  const prepared_problem& system() const { return *system_; }
  const std::vector<asked_metric>& metrics() const { return metrics_; }
  const std::vector<row>& rows() const { return rows_; }
  const std::vector<learned_row>& fits() const { return fits_; }
  const std::vector<method_source>& schemes() const { return schemes_; }
  /// Methods of `all` that do not apply, or not at some step, and why.
  const std::vector<std::pair<std::string, std::string>>& left_out() const { return left_out_; }
  const baselines& measured_baselines() const { return baselines_; }
  const std::optional<equal_bins>& bins(std::size_t metric) const { return bins_[metric]; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  bool has_result() const;
  /// Names of the scheme files of what is learned, usable or not.
  std::vector<std::string> scheme_files() const;

 private:
  using group = std::vector<row*>;  // of one step size

  static constexpr double reference_evaluations = 11.0;  // of one of order 6, a step
  static constexpr double fine_angle = 0.05;             // usual of such a step, of the fastest motion

  void name_metrics();
  /// Puts the names of the list in place of `all`.
  void name_methods();
  void require_sound_command() const;
  void require_sound_statistics() const;
  /// 0.5, or as long as the largest step needs the horizon to be.
  double usual_horizon(const std::vector<method_source>& sources) const;
  void plan_rows();
  void add_row(const method_source& source, double nominal);
  /// Why a method of `all` has no row at any step; empty if it may have.
  std::string why_not(const method_source& source) const;
  bool is_of_all(const std::string& name) const { return of_all_.contains(name); }
  trajectories_plan plan_at(double step) const;
  trajectories_plan paths_at(double step) const;
  /// Why a mean over time has too few samples at a step; empty if it has enough.
  std::string too_few_samples(const asked_metric& metric, double step) const;
  void require_enough_samples() const;
  json question_asked() const;
  void expect_work();
  double work_of_learning(const row& line) const;
  double work_of_paths(const group& all) const;
  double work_of_law(double evaluations_per_time) const;
  /// In evaluations, at their prices.
  double cost_of_step(const method_source& source) const;
  double work_of_reference() const;                    // of one ensemble for a distribution
  double evaluations_expected(const row& line) const;  // by unit time, without the start

  void learn(row& line, work_file& kept);
  void measure_paths(double step, const group& all, work_file& kept);
  std::vector<asked_metric> along_paths() const;
  /// Coarser than the usual where the rows' errors allow it; nothing: the usual one.
  std::optional<double> fine_step_for(double step, const std::vector<method>& methods) const;
  double refinement(const errors_plan& pilot, const std::vector<method>& methods) const;
  void take(std::size_t metric, double step, const group& all, const measured& found);
  void measure_acceptance(std::size_t metric, double step, const group& all, work_file& kept);
  void measure_law(std::size_t metric, double step, const group& all, work_file& kept);
  statistics_plan statistics_at(std::size_t metric, double step) const;
  void prepare_bins(std::size_t metric);
  gathered_statistics reference(std::size_t metric, double step, int number, int finer);
  const std::vector<gathered_statistics>& references_at(std::size_t metric, double step);
  std::optional<double> null_model_of_law(std::size_t metric, double step, const drawn_law& law);
  baseline baseline_of_law(std::size_t metric, double step);
  measurement law_of(std::size_t metric, const row& line, std::span<const gathered_statistics> all);
  void require_samples_in_range(std::size_t metric, std::span<const gathered_statistics> all) const;
  void measure_seconds();
  void judge_steps();
  void follow_energies(work_file& kept);

  comparison_options options_;
  common_settings common_;
  double horizon_ = 0.0;
  std::unique_ptr<prepared_problem> system_;
  std::vector<asked_metric> metrics_;
  std::map<std::string, method_source> families_;  // of the methods that are learned, by what was typed
  std::vector<method_source> schemes_;             // of the methods that come from files
  std::set<std::string> of_all_;                   // names that `all` stands for, and that were not typed
  std::vector<std::pair<std::string, std::string>> left_out_;  // name and reason
  std::vector<row> rows_;
  json question_;
  std::vector<learned_row> fits_;
  baselines baselines_;
  std::vector<std::string> warnings_;
  std::vector<std::optional<equal_bins>> bins_;  // by metric
  std::vector<gathered_statistics> references_;  // of the present metric and step
  progress shown_;
};

}  // namespace nysalt::program
