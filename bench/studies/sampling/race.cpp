// SPDX-License-Identifier: BSL-1.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "../../../src/program/bundled_systems.hpp"
#include "chapters.hpp"
#include "nysalt/analysis/statistics.hpp"

namespace nysalt::sampling_benchmark {

namespace {

std::string with_error(const estimate& cost) {
  if (!std::isfinite(cost.mean)) return "not reached";
  return fmt::format("{:.4g} ± {:.2g}", cost.mean, cost.standard_error);
}

}  // namespace

void say(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

table all_rows() {
  return table(
      {"target", "word", "length", "step", "step_per_evaluation", "foretold_step", "acceptance", "step_taken",
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
              const std::vector<tried_length>& lengths, const extent& how) {
  const auto cost_of = [&](const outcome& run) {
    return judged_by == &error_curve::largest ? run.to_largest_error.mean : run.to_mean_error.mean;
  };
  race best;
  best.name = name;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [length, draws] : lengths) {
    const contest_options options{.length = length, .threads = how.threads};
    double logarithm = 0.0;
    for (auto& one : words) {
      one.step = step_with_error(of, one.word, one.step, energy_error_at(0.9), options);
      one.run = run_chains(of, one.word, one.step, measured, draws, options);
      if (one.step > length) {
        outcome shorter = run_chains(of, one.word, length, measured, draws, options);
        if (cost_of(shorter) < cost_of(one.run)) one.run = std::move(shorter);
      }
      // A word that does not reach the limit counts as if it did with the last draw.
      const double cost = cost_of(one.run);
      logarithm += std::log(std::min(cost, static_cast<double>(draws) * one.run.evaluations_of_draw));
      say(fmt::format("{}, length {:g}: {} step {:.4g}, takes {:.4g}, acceptance {:.3f}, cost {:.4g}", name,
                      length, one.word.name(), one.step, one.run.step, one.run.acceptance, cost));
    }
    if (best.length > 0.0 && !(logarithm < least)) continue;
    least = logarithm;
    best.length = length;
    best.words = words;
  }
  return best;
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
              fmt::format("{:.4f}", one.run.acceptance), fmt::format("{:.5g}", one.run.step),
              fmt::format("{:.3f}", one.run.evaluations_of_draw),
              fmt::format("{:.1f}", one.run.to_mean_error.mean),
              fmt::format("{:.1f}", one.run.to_largest_error.mean)});
  }
  to.table(shown);
}

}  // namespace nysalt::sampling_benchmark
