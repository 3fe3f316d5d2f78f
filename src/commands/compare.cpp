// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "../checks.hpp"
#include "../commands.hpp"
#include "../learning.hpp"
#include "../method_source.hpp"
#include "../output.hpp"
#include "../progress.hpp"
#include "../seeds.hpp"
#include "nysalt/analysis/timing.hpp"
#include "nysalt/report/work_precision.hpp"

namespace nysalt::program {

namespace {

/// One method at one step.
struct row {
  std::string method;  // as typed
  double nominal;      // the step as typed: of a whole step, or (equal cost) of an evaluation
  double step;         // that is taken
  std::optional<tabulated> coefficients{};
  std::string reason{};  // why there is no error
  double evaluations_per_time = 0.0;
  double seconds_per_time = 0.0;
  estimate error{};
  std::optional<double> reference_error{};
  std::int64_t diverged = 0;
};

class comparison {
 public:
  comparison(const compare_command& command, const common_settings& common)
      : command_(command), common_(common), system_(make_system(command.system)) {
    if (command_.observable.empty()) command_.observable = system_->default_observable();
    require_sound_command();
    plan_rows();
  }

  void learn_and_measure() {
    for (auto& its : rows_) {
      if (const auto family = families_.find(its.method); family != families_.end()) {
        learn_for(its, family->second);
      }
    }
    measure_errors();
    measure_seconds();
    shown_.clear();
    warn_of_reference();
  }

  bool has_result() const {
    return std::any_of(rows_.begin(), rows_.end(),
                       [](const row& its) { return !std::isnan(its.error.mean); });
  }

  json document() const;
  std::string readable() const;
  void write(const std::filesystem::path& folder) const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void require_sound_command() const {
    if (command_.methods.empty()) refuse("--methods is needed, such as verlet,mclachlan2,learned:nystrom");
    if (command_.steps.empty()) refuse("--steps is needed, such as 0.01,0.02");
    for (const double step : command_.steps) require_positive("--steps", step);
    require_at_least_one("--trajectories", command_.trajectories);
    require_sound(command_.learning, "--learn-");
    system_->require_measure(command_.metric, command_.observable);
  }

  /// Which method at which step. A scheme file has a row where its own step is asked for.
  void plan_rows() {
    std::vector<method_source> sources;
    for (const auto& typed : command_.methods) {
      sources.push_back(find_method(typed));
      if (std::count(command_.methods.begin(), command_.methods.end(), typed) > 1) {
        refuse("--methods names {} twice", typed);
      }
      if (sources.back().family) families_[typed] = *sources.back().family;
    }
    for (const double nominal : command_.steps) {
      for (const auto& source : sources) {
        const double step = command_.equal_cost ? nominal * source.evaluations_per_step : nominal;
        const bool elsewhere = source.learned && !common_.force &&
                               !(std::abs(step - source.learned->step) <= 1e-9 * source.learned->step);
        if (elsewhere) continue;
        steps_within("--horizon", command_.horizon, step);
        row its{source.typed, nominal, step};
        if (source.family) {
          steps_within("--learn-horizon", command_.learning.horizon, step);
        } else {
          its.coefficients = coefficients_at(source, *system_, step, common_.force, warnings_);
        }
        rows_.push_back(std::move(its));
      }
    }
    for (const auto& source : sources) {
      const bool has_row =
          std::any_of(rows_.begin(), rows_.end(), [&](const row& its) { return its.method == source.typed; });
      if (has_row) continue;
      refuse("{} was learned for the step {}{}, which is not among --steps; add it, or take --force",
             source.typed, source.learned->step,
             command_.equal_cost
                 ? fmt::format(" ({} for an evaluation)", source.learned->step / source.evaluations_per_step)
                 : "");
    }
  }

  trajectories_plan plan_at(double step) const {
    return {step, steps_within("--horizon", command_.horizon, step), command_.trajectories,
            seed_for(role::test, common_.seed), common_.threads};
  }

  void learn_for(row& its, const std::string& family) {
    const learn_plan plan{family,
                          its.step,
                          command_.learning,
                          seed_for(role::training, common_.seed),
                          seed_for(role::held_out, common_.seed),
                          common_.threads};
    const learned_scheme learned = learn_with(*system_, plan, shown_);
    json fit{{"method", its.method}};
    fit.update(fit_json(learned.fit));
    fits_.push_back(fit);
    its.coefficients = learned.method;
    if (!learned.fit.usable) its.reason = "the fit is not usable: " + learned.fit.reason;
  }

  /// Rows at one step share the reference.
  void measure_errors() {
    std::map<double, std::vector<row*>> by_step;
    for (auto& its : rows_) by_step[its.step].push_back(&its);
    for (const auto& [step, group] : by_step) {
      const trajectories_plan plan = plan_at(step);
      std::vector<tabulated> methods;
      std::vector<row*> measured;
      for (row* its : group) {
        const auto evaluations = static_cast<double>(system_->count_evaluations(*its->coefficients, plan));
        its->evaluations_per_time = evaluations / (static_cast<double>(plan.steps) * step);
        if (!its->reason.empty()) continue;
        methods.push_back(*its->coefficients);
        measured.push_back(its);
      }
      if (methods.empty()) continue;
      shown_.part(fmt::format("comparing at step {:g}", step));
      const auto found = system_->errors(methods, plan, command_.metric, command_.observable,
                                         command_.learning.fine_step, shown_.counter(plan.count));
      reference_ = found.reference;
      for (std::size_t k = 0; k < measured.size(); ++k) {
        row& its = *measured[k];
        its.error = found.methods[k].error;
        its.diverged = found.methods[k].diverged;
        if (found.reference_error) its.reference_error = found.reference_error->mean;
        if (its.diverged == plan.count) {
          its.reason = fmt::format("every trajectory diverged, the first of them at step {}",
                                   found.methods[k].diverged_at.front().step);
        }
      }
    }
  }

  /// In turns, so that a machine that slows down slows all; each job long enough for the clock.
  void measure_seconds() {
    constexpr double evaluations_of_job = 2e5;  // some milliseconds
    constexpr int rounds = 7;
    shown_.part("timing");
    std::vector<std::function<void()>> jobs;
    std::vector<double> simulated;
    for (const auto& its : rows_) {
      trajectories_plan plan = plan_at(its.step);
      const double time = static_cast<double>(plan.steps) * its.step;
      const double of_one = its.evaluations_per_time * time;
      plan.count = std::clamp<std::int64_t>(static_cast<std::int64_t>(evaluations_of_job / of_one), 1,
                                            std::min<std::int64_t>(plan.count, 64));
      const double of_all = of_one * static_cast<double>(plan.count);
      const int repeats = static_cast<int>(std::ceil(evaluations_of_job / of_all));
      jobs.emplace_back([once = system_->timed_run(*its.coefficients, plan), repeats] {
        for (int n = 0; n < repeats; ++n) once();
      });
      simulated.push_back(time * static_cast<double>(plan.count) * repeats);
    }
    const auto seconds = interleaved_medians(jobs, rounds);
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].seconds_per_time = seconds[i] / simulated[i];
  }

  void warn_of_reference() {
    for (const auto& its : rows_) {
      if (!its.reference_error || std::isnan(its.error.mean)) continue;
      if (*its.reference_error <= 0.1 * its.error.mean) continue;
      warnings_.push_back(fmt::format(
          "the reference's own error {:.1e} is not ten times smaller than that of {} at step {:g}, {:.1e}",
          *its.reference_error, its.method, its.nominal, its.error.mean));
    }
  }

  std::vector<work_precision_row> work_precision_rows() const {
    std::vector<work_precision_row> result;
    for (const auto& its : rows_) {
      result.push_back({its.method, its.nominal, its.evaluations_per_time, its.seconds_per_time, its.error,
                        its.diverged, command_.trajectories});
    }
    return result;
  }

  std::string quantity() const {
    return command_.metric == "path" ? "path error of " + command_.observable : command_.metric + " error";
  }

  compare_command command_;
  common_settings common_;
  std::unique_ptr<bundled_system> system_;
  std::map<std::string, std::string> families_;  // of the methods that are learned
  std::vector<row> rows_;
  json fits_ = json::array();
  std::string reference_;
  std::vector<std::string> warnings_;
  progress shown_;
};

json comparison::document() const {
  json rows = json::array();
  for (const auto& its : rows_) {
    rows.push_back({{"method", its.method},
                    {"step", its.nominal},
                    {"step_size", its.step},
                    {"evaluations_per_time", its.evaluations_per_time},
                    {"seconds_per_time", its.seconds_per_time},
                    {"error", its.error.mean},
                    {"standard_error", its.error.standard_error},
                    {"diverged", its.diverged},
                    {"reference_error", its.reference_error ? json(*its.reference_error) : json(nullptr)}});
    if (!its.reason.empty()) rows.back()["reason"] = its.reason;
  }
  return {{"system", system_->description()},
          {"starts", system_->law()},
          {"metric", command_.metric},
          {"observable", command_.metric == "path" ? json(command_.observable) : json(nullptr)},
          {"horizon", command_.horizon},
          {"trajectories", command_.trajectories},
          {"equal_cost", command_.equal_cost},
          {"seed", common_.seed},
          {"reference", reference_.empty() ? json(nullptr) : json(reference_)},
          {"rows", rows},
          {"fits", fits_},
          {"warnings", warnings_}};
}

std::string comparison::readable() const {
  std::string text = fmt::format("{}, {} trajectories over {:g}, {}", system_->description(),
                                 command_.trajectories, command_.horizon, quantity());
  if (!reference_.empty()) text += fmt::format("\nreference: {}", reference_);
  if (command_.equal_cost) text += "\nsteps are per force evaluation: equal steps, equal cost";
  text += "\n\n" + work_precision_table(work_precision_rows()).text();
  for (const auto& its : rows_) {
    if (!its.reason.empty())
      text += fmt::format("{} at step {:g}: {}\n", its.method, its.nominal, its.reason);
  }
  return text;
}

/// Table and pictures.
void comparison::write(const std::filesystem::path& folder) const {
  const auto rows = work_precision_rows();
  make_folder(folder);
  write_result(folder / "table.md", work_precision_table(rows).markdown(), common_);
  table all({"method", "step", "step_size", "evaluations_per_time", "seconds_per_time", "error",
             "standard_error", "diverged"});
  for (const auto& its : rows_) {
    const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string(); };
    all.add({its.method, number(its.nominal), number(its.step), number(its.evaluations_per_time),
             number(its.seconds_per_time), number(its.error.mean), number(its.error.standard_error),
             fmt::format("{}", its.diverged)});
  }
  write_result(folder / "rows.csv", all.csv(), common_);
  const std::string emphasised = families_.empty() ? "" : families_.begin()->first;
  figure evaluations{"error_against_evaluations",
                     {work_precision_panel(rows, emphasised, "force evaluations per unit time",
                                           &work_precision_row::evaluations_per_time)}};
  figure seconds{"error_against_seconds",
                 {work_precision_panel(rows, emphasised, "seconds per unit time",
                                       &work_precision_row::seconds_per_time)}};
  evaluations.panels[0].y_label = seconds.panels[0].y_label = quantity();
  const bool drawn = draw(evaluations, folder) && draw(seconds, folder);
  if (!drawn) warn("gnuplot could not draw the pictures: is it installed? Scripts and data are there");
}

}  // namespace

int compare(const compare_command& command, const common_settings& common) {
  comparison all(command, common);
  const std::filesystem::path folder(command.output);
  if (!command.output.empty()) require_folder(folder);
  all.learn_and_measure();
  if (!command.output.empty()) all.write(folder);
  if (common.json) {
    print(all.document().dump(2) + "\n");
  } else {
    print(all.readable());
    for (const auto& text : all.warnings()) warn(text);
    if (!command.output.empty()) print(fmt::format("Written: {}\n", command.output));
  }
  return all.has_result() ? done : no_result;
}

}  // namespace nysalt::program
