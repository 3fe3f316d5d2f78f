// SPDX-License-Identifier: BSL-1.0
#include "coverage.hpp"
#include "../../../src/program/systems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../../../src/comparison/catalogue.hpp"
#include "../../../src/comparison/checks.hpp"
#include "../../../src/comparison/seeds.hpp"
#include "../../../src/program/bundled_systems.hpp"
#include "../../../src/report/page.hpp"
#include "../../../src/report/table.hpp"

namespace nysalt::coverage {

using namespace nysalt::program;

namespace {

std::vector<asked_metric> metrics_of(const prepared_problem& system) {
  std::vector<asked_metric> result{
      {"state"}, {"path", system.default_observable()}, {"path", "q1"}, {"energy"}};
  if (system.default_observable() == "stiff_energy") result.push_back({"exchange"});
  return result;
}

method method_of(const std::string& name) {
  const auto& all = classical_methods();
  return std::ranges::find(all, name, [](const auto& entry) { return entry.method.name(); })->method;
}

/// Errors of one method at one step by all metrics, over trajectories of a seed.
std::vector<method_error> errors(const prepared_problem& system, const method& method, double step,
                                 double horizon, std::int64_t count, std::uint64_t seed, int threads) {
  const errors_plan plan{.trajectories = {step, steps_beyond("horizon", horizon, step), count,
                                          seed_for(role::test, seed), threads, horizon},
                         .metrics = metrics_of(system),
                         .fine_step = system.fine_step_for_ranking(step)};
  std::vector<method_error> result;
  for (const auto& by_metric : system.errors({method}, plan, {})) result.push_back(by_metric.methods.front());
  return result;
}

constexpr double of_interval = 1.96;  // standard errors, for 95 %

bool within(const estimate& a, const estimate& b, double deviations) {
  return std::abs(a.mean - b.mean) <= deviations * std::hypot(a.standard_error, b.standard_error);
}

std::vector<row> rows_at(const prepared_problem& system, const std::string& name, const std::string& method,
                         double step, double horizon, const extent& what) {
  const auto run = [&](std::int64_t count, std::uint64_t seed) {
    return errors(system, method_of(method), step, horizon, count, seed, what.threads);
  };
  std::uint64_t seed = 1;
  const auto many = run(what.many, seed);
  const auto metrics = metrics_of(system);
  std::vector<row> rows;
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    rows.push_back({.system = name,
                    .metric = metrics[m].text(),
                    .method = method,
                    .step = step,
                    .truth = many[m].error,
                    .truth_has_tail = many[m].spread.largest.is_heavy(),
                    .samples = what.samples,
                    .between = {}});
  }
  bool has_lost = many.front().diverged > 0;
  for (int k = 0; k < what.samples; ++k) {
    const auto sample = run(what.of_sample, ++seed);
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      const bool covers = within(sample[m].error, rows[m].truth, of_interval);
      const bool is_marked = sample[m].spread.largest.is_heavy();
      rows[m].covered += covers;
      rows[m].marked += is_marked;
      rows[m].misled += !covers && !is_marked;
      has_lost = has_lost || sample[m].diverged > 0;
    }
  }
  for (const std::int64_t count : what.between) {
    const auto other = run(count, ++seed);
    for (std::size_t m = 0; m < metrics.size(); ++m) {
      rows[m].between.push_back(other[m].error);
      const bool is_marked = other[m].spread.largest.is_heavy() || rows[m].has_tail();
      rows[m].agrees = rows[m].agrees && (is_marked || within(other[m].error, rows[m].truth, 3.0));
    }
  }
  if (has_lost) rows.clear();
  return rows;
}

std::vector<std::string> names_of(const extent& what) {
  if (!what.systems.empty()) return what.systems;
  std::vector<std::string> all;
  for (const auto& declared : bundled_declarations()) all.push_back(declared.name);
  return all;
}

}  // namespace

std::vector<row> covered_rows(const extent& what) {
  std::vector<row> result;
  for (const auto& name : names_of(what)) {
    system_settings settings;
    settings.name = name;
    const auto system = make_system(settings);
    system->prepare_starts(1);
    const double frequency = system->fastest_rate();
    const double horizon = what.turns / frequency;
    for (const double angle : what.angles) {
      for (const auto& method : what.methods) {
        const double step = angle / frequency * method_of(method).letters().evaluations_per_step;
        if (horizon / step < fewest_samples) continue;
        const auto rows = rows_at(*system, name, method, step, horizon, what);
        result.insert(result.end(), rows.begin(), rows.end());
      }
    }
  }
  return result;
}

std::string csv_of(const std::vector<row>& all) {
  table result({"system", "metric", "method", "step", "error", "standard_error", "covered", "marked",
                "misled", "samples", "tail", "agrees"});
  for (const row& line : all) {
    result.add({line.system, line.metric, line.method, fmt::format("{}", line.step),
                fmt::format("{}", line.truth.mean), fmt::format("{}", line.truth.standard_error),
                fmt::format("{}", line.covered), fmt::format("{}", line.marked),
                fmt::format("{}", line.misled), fmt::format("{}", line.samples), line.has_tail() ? "1" : "0",
                line.agrees ? "1" : "0"});
  }
  return result.csv();
}

std::string page_of(const std::vector<row>& all, const extent& what) {
  page result("Error bars");
  result.text(fmt::format(
      "Do the 95 % intervals of {} trajectories cover what {} say? {} samples each, by every metric of every "
      "bundled system, with the program's starts, over {:g} radians of the fastest motion. An interval "
      "covers "
      "if it and that of the {} are not farther apart than both together allow. `tail`: few trajectories "
      "decide "
      "the mean (Cochran's rule), marked for each sample by itself, and of the row if most samples are "
      "marked, "
      "or "
      "the {}. A sample misleads if it neither covers nor is marked. Errors of other numbers of trajectories "
      "({}) agree if they lie within three standard errors, or are marked.",
      what.of_sample, what.many, what.samples, what.turns, what.many, what.many,
      fmt::join(what.between, ", ")));
  result.code("./dev error-bars");
  const auto count = [&](const auto& is_so) { return std::ranges::count_if(all, is_so); };
  result.list(
      {fmt::format("{} rows; {} cover at least 13 of 16, {} are marked `tail`, {} neither", all.size(),
                   count([](const row& line) { return line.covers(); }),
                   count([](const row& line) { return line.has_tail(); }),
                   count([](const row& line) { return !line.covers() && !line.has_tail(); })),
       fmt::format("in {} rows errors at other numbers of trajectories do not agree",
                   count([](const row& line) { return !line.agrees; })),
       fmt::format("in {} rows more than three of 16 samples mislead: no sample shows what none has met",
                   count([](const row& line) { return 16 * line.misled > 3 * line.samples; })),
       fmt::format("of the rows that cover, {} are marked: their intervals are better than the rule asks",
                   count([](const row& line) { return line.covers() && line.has_tail(); }))});
  table rows({"system", "metric", "method", "step", "error", "covered", "marked", "mislead", "row", "agree"},
             3);
  for (const row& line : all) {
    rows.add({line.system, line.metric, line.method, fmt::format("{:.3g}", line.step),
              fmt::format("{:.2e} ± {:.0e}", line.truth.mean, line.truth.standard_error),
              fmt::format("{}/{}", line.covered, line.samples), fmt::format("{}", line.marked),
              fmt::format("{}", line.misled),
              line.has_tail() ? "tail"
              : line.covers() ? "covers"
                              : "NOT SO",
              line.agrees ? "yes" : "NO"});
  }
  result.table(rows);
  return result.markdown();
}

}  // namespace nysalt::coverage
