// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "../../src/program/bundled_systems.hpp"
#include "chapters.hpp"
#include "nysalt/analysis/statistics.hpp"

namespace nysalt::sampling_benchmark {

namespace {

std::string with_error(const std::vector<double>& values) {
  if (!std::ranges::all_of(values, [](double x) { return std::isfinite(x); })) return "not reached";
  const estimate found = mean_and_error(values);
  if (values.size() < 2) return fmt::format("{:.3g}", found.mean);
  return fmt::format("{:.4g} ± {:.2g}", found.mean, found.standard_error);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x / static_cast<double>(values.size());
  return sum;
}

}  // namespace

void say(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

table all_rows() {
  return table({"target", "word", "length", "step", "step_per_evaluation", "foretold_step", "acceptance",
                "evaluations_of_draw", "evaluations_to_low_mean_error", "evaluations_to_low_largest_error"},
               2);
}

model bundled(const std::string& name, const std::vector<std::pair<std::string, parameter_value>>& given) {
  for (const auto& declared : program::bundled_declarations()) {
    if (declared.name != name) continue;
    parameter_values values;
    for (const auto& parameter : declared.parameters) {
      const auto found = std::ranges::find(given, parameter.name, [](const auto& one) { return one.first; });
      values.add(parameter.name, found == given.end() ? parameter.usual : found->second);
    }
    return declared.make(values, bath::of_sigma(0.0, 0.0), 1.0).system;
  }
  throw std::invalid_argument("there is no bundled system " + name);
}

race run_race(const std::string& name, const target& of, std::vector<contender> words,
              const statistic& measured, std::vector<double> error_curve::*judged_by,
              const std::vector<tried_length>& lengths, int repetitions, const extent& how) {
  const bool by_largest = judged_by == &error_curve::largest;
  const auto costs_of = [&](const outcome& run) {
    return by_largest ? run.to_largest_error : run.to_mean_error;
  };
  std::vector<contender> best;
  const tried_length* chosen = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& tried : lengths) {
    const contest_options options{.length = tried.length, .threads = how.threads};
    double logarithm = 0.0;
    for (auto& one : words) {
      one.step = step_with_error(of, one.word, one.step, energy_error_at(0.9), options);
      one.run = run_chains(of, one.word, std::min(one.step, tried.length), measured, tried.draws, 1, options);
      logarithm += std::log(mean_of(costs_of(one.run)));
      say(fmt::format("{}, length {:g}: {} step {:.4g}, acceptance {:.3f}, cost {:.4g}", name, tried.length,
                      one.word.name(), one.step, one.run.acceptance, mean_of(costs_of(one.run))));
    }
    if (chosen != nullptr && !(logarithm < least)) continue;
    least = logarithm;
    chosen = &tried;
    best = words;
  }
  const contest_options options{.length = chosen->length, .threads = how.threads};
  if (repetitions > 1) {
    for (auto& one : best)
      one.run = run_chains(of, one.word, one.run.step, measured, chosen->draws, repetitions, options);
  }
  return {name, std::move(best), chosen->length};
}

void add_race(const race& of, page& to, table& rows, bool by_largest) {
  const bool has_foretold =
      std::ranges::any_of(of.words, [](const contender& one) { return one.foretold > 0.0; });
  const bool has_published =
      std::ranges::any_of(of.words, [](const contender& one) { return !one.published.empty(); });
  std::vector<std::string> columns{"word", "step per gradient"};
  if (has_foretold) columns.push_back("foretold");
  columns.insert(columns.end(), {"acceptance", "gradients a draw"});
  if (by_largest) columns.push_back("gradients, largest error");
  columns.push_back("gradients, mean error");
  if (has_published) columns.push_back("published");
  table shown(columns);
  for (const auto& one : of.words) {
    const double evaluations = one.word.letters().evaluations_per_step;
    std::vector<std::string> cells{one.word.name(), fmt::format("{:.4f}", one.step / evaluations)};
    if (has_foretold)
      cells.push_back(one.foretold > 0.0 ? fmt::format("{:.4f}", one.foretold / evaluations) : "");
    cells.push_back(fmt::format("{:.3f}", one.run.acceptance));
    cells.push_back(fmt::format("{:.1f}", one.run.evaluations_of_draw));
    if (by_largest) cells.push_back(with_error(one.run.to_largest_error));
    cells.push_back(with_error(one.run.to_mean_error));
    if (has_published) cells.push_back(one.published);
    shown.add(cells);
    rows.add({of.name, one.word.name(), fmt::format("{:g}", of.length), fmt::format("{:.5g}", one.step),
              fmt::format("{:.5g}", one.step / evaluations), fmt::format("{:.5g}", one.foretold),
              fmt::format("{:.4f}", one.run.acceptance), fmt::format("{:.3f}", one.run.evaluations_of_draw),
              fmt::format("{:.1f}", mean_of(one.run.to_mean_error)),
              fmt::format("{:.1f}", mean_of(one.run.to_largest_error))});
  }
  to.table(shown);
}

}  // namespace nysalt::sampling_benchmark
