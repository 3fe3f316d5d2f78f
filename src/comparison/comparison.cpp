// SPDX-License-Identifier: BSL-1.0
// Plan of a comparison: metrics, and rows of methods at steps.
#include "comparison.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "build_info.hpp"
#include "catalogue.hpp"
#include "checks.hpp"
#include "declared_prices.hpp"
#include "learning.hpp"
#include "nysalt/stepping/served_letters.hpp"
#include "purpose.hpp"
#include "refusal.hpp"
#include "seeds.hpp"

namespace nysalt::program {

void require_fitting(const comparison_options& asked, const std::function<bool(const char*)>& is_given) {
  const auto belongs = [&](const char* field, const std::vector<std::string>& metrics) {
    const auto is_of_these = [&](const std::string& text) {
      const bool names_observable =
          std::string_view(field) == "observable" && text.find(':') != std::string::npos;
      return std::ranges::count(metrics, text.substr(0, text.find(':'))) > 0 && !names_observable;
    };
    if (!is_given(field) || std::ranges::any_of(asked.metrics, is_of_these)) return;
    refuse_value(field, "must come with {} {}, got {}", spelled("metrics"),
                 fmt::format("{}", fmt::join(metrics, " or ")), listed(asked.metrics));
  };
  belongs("observable", {"path", "relative", "distribution", "acf"});
  belongs("range", {"distribution"});
  belongs("bins", {"distribution"});
  belongs("longest_lag", {"acf"});
  belongs("hmc_temperature", {"acceptance"});
  const auto is_learned = [](const std::string& method) { return method.starts_with("learned:"); };
  if (std::ranges::any_of(asked.methods, is_learned)) return;
  for (const char* field : {"purpose", "learning.trajectories", "learning.horizon", "learning.loss",
                            "learning.effort", "learning.random_starts", "coordinates", "fix"}) {
    if (!is_given(field)) continue;
    refuse_value(field, "must come with a method that is learned, got {}; leave {} away",
                 listed(asked.methods), spelled(field));
  }
}

comparison::comparison(std::unique_ptr<prepared_problem> system, comparison_options asked,
                       common_settings common)
    : options_(std::move(asked)), common_(std::move(common)), system_(std::move(system)) {
  name_metrics();
  name_methods();
  require_sound_command();
  plan_rows();
  question_ = question_asked();
}

bool comparison::has_result() const {
  return std::ranges::any_of(rows_, [](const row& line) {
    return std::ranges::any_of(line.measurements, [](const measurement& one) { return one.reason.empty(); });
  });
}

std::vector<std::string> comparison::scheme_files() const {
  std::vector<std::string> names;
  for (const row& line : rows_) {
    if (families_.contains(line.method)) names.push_back(scheme_file(line.method, line.step));
  }
  return names;
}

void comparison::name_metrics() {
  const std::string otherwise =
      options_.observable.empty() ? system_->default_observable() : options_.observable;
  for (const auto& text : options_.metrics) metrics_.push_back(metric_named(text, otherwise));
  bins_.resize(metrics_.size());
  settle_purpose(options_.learning, system_->heat_bath(), "learning.");
}

void comparison::name_methods() {
  std::vector<std::string> names;
  const std::vector<std::string>& typed = options_.methods;
  for (const auto& name : typed) {
    if (name != every_method || options_.held.contains(name)) {
      names.push_back(options_.held.contains(name) ? name : canonical_method(name));
      continue;
    }
    for (const auto& known : method_names()) {
      if (std::ranges::count(typed, known, canonical_method) == 0 && of_all_.insert(known).second)
        names.push_back(known);
    }
  }
  options_.methods = std::move(names);
}

void comparison::require_sound_command() const {
  if (options_.methods.empty()) {
    refuse_value("methods",
                 "must be one or more, got none; name methods, such as verlet,learned:nystrom, or all");
  }
  if (options_.steps.empty()) {
    refuse_value("steps", "must be one or more, got none; give steps, such as 0.01,0.02");
  }
  if (options_.metrics.empty()) {
    refuse_value("metrics", "must be one or more, got none; name metrics, such as path,energy");
  }
  for (const double step : options_.steps) require_positive("steps", step);
  for (const double level : options_.levels) require_positive("levels", level);
  require_different("steps", options_.steps);
  require_different("levels", options_.levels);
  require_different("methods", options_.methods);
  std::vector<std::string> metrics;
  for (const auto& metric : metrics_) metrics.push_back(metric.text());
  require_different("metrics", metrics);
  require_at_least_one("trajectories", options_.trajectories);
  require_sound_prices(options_.prices, system_->letters());
  require_sound(options_.learning, "learning.");
  if (std::ranges::any_of(metrics_, &asked_metric::is_of_law)) require_sound_statistics();
  if (std::ranges::any_of(metrics_, &asked_metric::is_acceptance)) {
    require_positive("hmc_temperature", options_.hmc_temperature);
  }
}

double comparison::cost_of_step(const method_source& source) const {
  const double saved = source.word->evaluations_per_step - priced_evaluations(*source.word, options_.prices);
  return source.evaluations_per_step - saved;
}

double comparison::usual_horizon(const std::vector<method_source>& sources) const {
  double largest = 0.0;
  for (const auto& source : sources) {
    const double evaluations = options_.equal_cost ? cost_of_step(source) : 1.0;
    largest = std::max(largest, evaluations * std::ranges::max(options_.steps));
  }
  return std::max(0.5, fewest_samples * largest);
}

void comparison::plan_rows() {
  std::vector<method_source> sources;
  for (const auto& typed : options_.methods) {
    sources.push_back(find_method(typed, options_.held, system_->letters()));
    charge(sources.back(), *system_);
    if (sources.back().family) families_[typed] = sources.back();
    if (sources.back().learned) schemes_.push_back(sources.back());
    if (!is_of_all(typed)) continue;
    if (const std::string reason = why_not(sources.back()); !reason.empty()) {
      left_out_.emplace_back(typed, reason);
      sources.pop_back();
    }
  }
  horizon_ = options_.horizon.value_or(usual_horizon(sources));
  for (const double nominal : options_.steps) {
    for (const auto& source : sources) {
      if (!is_of_all(source.typed)) {
        add_row(source, nominal);
        continue;
      }
      const auto leave_out = [&](std::string reason) {
        if (reason.starts_with(source.typed + " ")) reason.erase(0, source.typed.size() + 1);
        left_out_.emplace_back(source.typed, fmt::format("{} (step {:g})", reason, nominal));
      };
      try {
        add_row(source, nominal);
      } catch (const refusal& problem) {
        leave_out(problem.what());
      } catch (const std::invalid_argument& problem) {
        leave_out(problem.what());
      }
    }
  }
  const auto has_no_row = [&](const std::string& name) {
    return std::ranges::count(rows_, name, &row::method) == 0;
  };
  if (rows_.empty() && !left_out_.empty()) {
    refuse_value("methods", "must have one that applies, got none: {}: {}", left_out_.back().first,
                 left_out_.back().second);
  }
  std::erase_if(options_.methods,
                [&](const std::string& name) { return is_of_all(name) && has_no_row(name); });
  for (const auto& source : sources) {
    if (is_of_all(source.typed) || !has_no_row(source.typed)) continue;
    if (!source.learned) refuse("{}", warnings_.back());
    const double evaluations = options_.equal_cost ? cost_of_step(source) : 1.0;
    refuse("{}{} must hold {}, for which {} was learned; add {}, or take {}", spelled("steps"),
           options_.equal_cost ? " (of an evaluation)" : "", source.learned->steps(), source.typed,
           source.learned->curve.steps().back() / evaluations, switched_on("force"));
  }
  require_enough_samples();
}

std::string comparison::why_not(const method_source& source) const {
  const nysalt::word& word = *source.word;
  if (!system_->heat_bath().acts() && word.stochastic_letters > 0) return "it is for a bath";
  if (source.typed.ends_with("_2x")) return "it is two steps of another method";
  if (!word.is_symplectic && std::ranges::none_of(metrics_, &asked_metric::is_acceptance))
    return "it is not symplectic, and for Hybrid Monte Carlo only";
  try {
    system_->require_served(word);
  } catch (const refusal& problem) {
    return problem.what();
  }
  return objection_to_order(source, *system_);
}

/// A scheme file has a row where its own step is asked for, and nowhere else.
void comparison::add_row(const method_source& source, double nominal) {
  const double step = options_.equal_cost ? nominal * cost_of_step(source) : nominal;
  const bool elsewhere = source.learned && !is_at(*source.learned, step);
  if (elsewhere && !common_.force) return;
  row planned{.method = source.typed, .nominal = nominal, .step = step};
  planned.is_learned = source.family || source.learned;
  if (source.evaluations_per_step > 0)
    planned.share_of_evaluation = cost_of_step(source) / source.evaluations_per_step;
  planned.measurements.resize(metrics_.size());
  const auto otherwise = placement_asked(options_.placement);
  const bool is_noisy = system_->heat_bath().acts() && system_->heat_bath().sigma() > 0.0;
  int parts = 1;
  bool symmetric = false;
  if (source.family) {
    symmetric = family_named(*source.family, system_->letters()).symmetric;
    steps_within("learning.horizon", options_.learning.horizon_at(step), step);
    const auto where = placement_in(source, *system_, otherwise);
    system_->require_learnable(*source.family, where, options_.learning, step);
    if (where == placement::symmetric) parts = 2;
  } else {
    try {
      std::vector<std::string> of_all;  // their margins say which are not stable
      planned.coefficients = coefficients_at(source, *system_, step, common_.force, otherwise,
                                             is_of_all(source.typed) ? of_all : warnings_);
      planned.frequency = frequency_of(source, *system_);
    } catch (const refusal& problem) {
      // Coefficients that follow from the step may end; other steps have their rows.
      const bool is_only_step = options_.steps.size() == 1;
      if (source.adaptive == nullptr || is_only_step || is_of_all(source.typed)) throw;
      warnings_.push_back(fmt::format("{} (no row at step {:g})", problem.what(), nominal));
      return;
    }
    symmetric = planned.coefficients->symmetric;
    if (is_noisy) parts = noise_parts(*planned.coefficients, *system_);
  }
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    const asked_metric& metric = metrics_[m];
    if (metric.is_acceptance() && !symmetric && !system_->heat_bath().acts()) {
      refuse("{} must be reversible for the metric acceptance; take a symmetric method", source.typed);
    }
    system_->require_measure(metric, metric.is_along_paths() ? paths_at(step) : plan_at(step),
                             options_.learning.fine_step, metric.is_of_law() ? 1 : parts);
    if (metric.is_of_law()) statistics_at(m, step);
    planned.measurements[m].reason = too_few_samples(metric, step);
  }
  rows_.push_back(std::move(planned));
}

trajectories_plan comparison::plan_at(double step) const {
  return {step, steps_within("horizon", horizon_, step), options_.trajectories,
          seed_for(role::test, common_.seed), common_.execution.threads};
}

/// To the horizon, over which errors are means.
trajectories_plan comparison::paths_at(double step) const {
  trajectories_plan plan = plan_at(step);
  plan.steps = steps_beyond("horizon", horizon_, step);
  plan.horizon = horizon_;
  return plan;
}

std::string comparison::too_few_samples(const asked_metric& metric, double step) const {
  const double samples = horizon_ / step;
  if (metric.is_acceptance() || samples >= fewest_samples - 1e-9) return {};
  return fmt::format(
      "{} must hold at least {:g} steps of {:g} for a mean over time, got {:g}, which holds {:.3g}; take at "
      "least {:g}",
      spelled("horizon"), fewest_samples, step, horizon_, samples, fewest_samples * step);
}

void comparison::require_enough_samples() const {
  const auto has_none = [](const row& line) {
    return std::ranges::none_of(line.measurements, [](const measurement& one) { return one.reason.empty(); });
  };
  if (std::ranges::all_of(rows_, has_none)) refuse("{}", rows_.front().measurements.front().reason);
}

namespace {

json as_json(const learning_options& how) {
  return {{"purpose", how.purpose},
          {"fine_step", how.fine_step ? json(*how.fine_step) : json(nullptr)},
          {"trajectories", how.trajectories},
          {"horizon", how.horizon ? json(*how.horizon) : json(nullptr)},
          {"coordinates", how.coordinates},
          {"fix", how.fix},
          {"loss", how.loss},
          {"effort", how.effort},
          {"random_starts", how.random_starts ? json(*how.random_starts) : json(nullptr)}};
}

json as_json(const row& line) {
  json result{{"method", line.method}, {"step", line.nominal}, {"step_size", line.step}};
  if (!line.coefficients) return result;
  result["letters"] = line.coefficients->letters().letters();
  result["coefficients"] = line.coefficients->coefficients();
  return result;
}

}  // namespace

json comparison::question_asked() const {
  json metrics = json::array();
  for (const auto& metric : metrics_) metrics.push_back(metric.text());
  json rows = json::array();
  for (const auto& line : rows_) rows.push_back(as_json(line));
  json question{{"program", fmt::format("nysalt {}, {} {}", version, compiler, compiler_flags)},
                {"system", system_->parameters()},
                {"starts", {to_string(system_->start_law()), system_->starts()}},
                {"metric", metrics},
                {"rows", rows},
                {"placement", options_.placement},
                {"horizon", horizon_},
                {"trajectories", options_.trajectories},
                {"equal_cost", options_.equal_cost},
                {"levels", options_.levels},
                {"range", options_.range},
                {"bins", options_.bins},
                {"longest_lag", options_.longest_lag},
                {"hmc_temperature", options_.hmc_temperature},
                {"learning", as_json(options_.learning)},
                {"seed", common_.seed}};
  if (!options_.prices.empty()) question["prices"] = options_.prices;
  return question;
}

}  // namespace nysalt::program
