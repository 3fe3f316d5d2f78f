// SPDX-License-Identifier: BSL-1.0
// Pictures of errors against costs, and of distributions with that of the reference.
#include "comparison_pictures.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "comparison_tables.hpp"
#include "work_precision.hpp"

namespace nysalt::program {

namespace {

/// Of letters, digits and _, as files are called.
std::string plain(std::string text) {
  const auto is_other = [](unsigned char c) { return std::isalnum(c) == 0; };
  std::replace_if(text.begin(), text.end(), is_other, '_');
  return text;
}

/// Of all methods, or of those with these names.
std::vector<work_precision_row> points_of(const comparison& all, std::size_t m,
                                          const std::optional<std::vector<std::string>>& named = {}) {
  std::vector<work_precision_row> result;
  for (const row& line : all.rows()) {
    if (named && std::ranges::count(*named, line.method) == 0) continue;
    const measurement& one = line.measurements[m];
    result.push_back({.method = line.method,
                      .step = line.nominal,
                      .evaluations_per_time = line.evaluations_per_time,
                      .seconds_per_time = line.seconds_per_time.least,
                      .error = ranked_value(all, m, line),
                      .diverged = one.diverged,
                      .trajectories = all.options().trajectories,
                      .learned = line.is_learned,
                      .counts = is_ranked(all, m, line)});
  }
  return result;
}

/// The null model's error is a mean.
std::vector<level> levels_of(const comparison& all, std::size_t m) {
  std::vector<level> result;
  if (is_by_median(all, m)) return result;
  for (const auto& [name, value] : free_of_cost(all, m)) {
    const bool is_null = name == "null model";
    if (value > 0.0) result.push_back({is_null ? name + ": stays as at the start" : name, value});
  }
  return result;
}

figure against_cost(const comparison& all, std::size_t m, const char* name, const char* label,
                    double work_precision_row::*field, double (*cost)(const row&)) {
  panel plot = work_precision_panel(points_of(all, m, drawn_methods(all, m)), "", label, field);
  plot.y_label = (is_by_median(all, m) ? "median " : "") + quantity(all, m);
  plot.linear_y = all.metrics()[m].is_acceptance();
  std::vector<std::size_t> front;
  for (const row* best : pareto_front(all, m, cost)) {
    front.push_back(static_cast<std::size_t>(best - all.rows().data()));
  }
  if (front.size() > 1)
    plot.curves.push_back(front_curve(points_of(all, m), front, field, "best at its cost"));
  plot.levels = levels_of(all, m);
  return {.name = plain(all.metrics()[m].text()) + name, .panels = {plot}};
}

}  // namespace

std::vector<std::string> drawn_methods(const comparison& all, std::size_t m) {
  constexpr std::size_t most = 6;  // of each kind
  const auto& methods = all.options().methods;
  if (methods.size() <= 2 * most) return methods;
  std::set<std::string> chosen;
  for (const bool learned : {true, false}) {
    std::size_t found = 0;
    const auto add = [&](bool is_learned, const std::string& method) {
      if (is_learned != learned || found == most || !chosen.insert(method).second) return;
      ++found;
    };
    for (const double level : levels_for(all, m)) {
      for (const auto& cost : costs_at(all, m, level)) add(cost.is_learned, cost.method);
    }
    for (const row& line : all.rows()) add(line.is_learned, line.method);  // where no cost is known
  }
  std::vector<std::string> result;
  std::ranges::copy_if(methods, std::back_inserter(result),
                       [&](const std::string& method) { return chosen.contains(method); });
  return result;
}

std::vector<figure> pictures_of_errors(const comparison& all, std::size_t m) {
  const auto is_there = [&](const row& line) { return std::isfinite(ranked_value(all, m, line).mean); };
  if (std::ranges::none_of(all.rows(), is_there)) return {};
  return {against_cost(all, m, "_against_evaluations", "force evaluations per unit time",
                       &work_precision_row::evaluations_per_time, evaluations_of),
          against_cost(all, m, "_against_seconds", "seconds per unit time",
                       &work_precision_row::seconds_per_time, seconds_of)};
}

std::vector<figure> pictures_of_laws(const comparison& all, std::size_t m) {
  std::vector<figure> result;
  const asked_metric& metric = all.metrics()[m];
  if (!metric.is_of_law()) return result;
  const bool is_density = metric.name == "distribution";
  const auto methods = drawn_methods(all, m);
  const std::set<std::string> drawn(methods.begin(), methods.end());
  for (const double nominal : all.options().steps) {
    panel plot{.title = fmt::format("step {:g}", nominal),
               .x_label = is_density ? metric.observable : "lag",
               .y_label = is_density ? "density" : "normalised autocovariance of " + metric.observable,
               .curves = {}};
    for (const row& one : all.rows()) {
      const auto& law = one.measurements[m].law;
      if (one.nominal != nominal || !law || law->y.empty() || !drawn.contains(one.method)) continue;
      if (plot.curves.empty()) {
        const auto& reference = *all.measured_baselines().at({m, one.step}).law;
        plot.curves.push_back({.label = "reference", .x = reference.x, .y = reference.y, .emphasised = true});
      }
      plot.curves.push_back({.label = one.method, .x = law->x, .y = law->y});
    }
    if (plot.curves.empty()) continue;
    result.push_back({.name = plain(fmt::format("{}_at_{}", metric.text(), nominal)), .panels = {plot}});
  }
  return result;
}

std::vector<figure> pictures_of_energies(const comparison& all) {
  std::vector<figure> result;
  const auto methods = drawn_methods(all, 0);
  const std::set<std::string> drawn(methods.begin(), methods.end());
  for (const double nominal : all.options().steps) {
    panel errors{.title = fmt::format("step {:g}", nominal),
                 .x_label = "time",
                 .y_label = "energy error",
                 .log_log = true,
                 .curves = {},
                 .linear_x = true};
    panel survivors{.title = errors.title,
                    .x_label = "time",
                    .y_label = "share of trajectories that survive",
                    .curves = {},
                    .y_range = "[0:1.05]"};
    bool all_survive = true;
    for (const row& one : all.rows()) {
      if (one.nominal != nominal || !one.energies || !drawn.contains(one.method)) continue;
      const energy_course& course = *one.energies;
      if (course.t.size() < 2) continue;
      // At the start there is no error, which a logarithmic axis cannot show.
      errors.curves.push_back({.label = one.method,
                               .x = {course.t.begin() + 1, course.t.end()},
                               .y = {course.deviation.begin() + 1, course.deviation.end()},
                               .emphasised = one.is_learned});
      survivors.curves.push_back(
          {.label = one.method, .x = course.t, .y = course.surviving, .emphasised = one.is_learned});
      all_survive = all_survive && course.surviving.back() == 1.0;
    }
    if (errors.curves.empty()) continue;
    result.push_back({.name = plain(fmt::format("energy_at_{}", nominal)), .panels = {errors}});
    if (!all_survive)
      result.push_back({.name = plain(fmt::format("survivors_at_{}", nominal)), .panels = {survivors}});
  }
  return result;
}

}  // namespace nysalt::program
