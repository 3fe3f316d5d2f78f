// SPDX-License-Identifier: BSL-1.0
#include "judging.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "catalogue.hpp"
#include "refusal.hpp"
#include "stability.hpp"

namespace nysalt::program {

std::optional<energy_of_trial> energy_error_of(const judgement& found) {
  if (!found.energy_was_watched || found.diverged == found.trajectories) return std::nullopt;
  return energy_of_trial{{found.energy_error}, found.drift, found.growth};
}

std::optional<std::string> warning_of(const std::string& name, const judgement& found) {
  if (found.reason.empty()) return std::nullopt;
  return fmt::format("{} at step {:g}: {}", name, found.step, found.in_words());
}

namespace {

/// The first z below `end` at which a step turns an oscillator by a quarter, or the end.
double quarter_turn_of(const method& method, double end) {
  constexpr int samples = 1000;
  for (int i = 1; i <= samples; ++i) {
    double high = end * i / samples;
    if (half_trace_of(method, high) > 0.0) continue;
    double low = end * (i - 1) / samples;
    for (int halvings = 0; halvings < 50; ++halvings) {
      const double middle = std::midpoint(low, high);
      (half_trace_of(method, middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return end;
}

/// To three digits.
double rounded_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::floor(x / unit) * unit;
}

}  // namespace

double linear_step(const method& method, const stability_chart& chart, double highest_frequency) {
  if (chart.windows.empty() || chart.windows.front().low > 0.0 || !(highest_frequency > 0.0)) return 0.0;
  double end = chart.windows.front().high;
  if (!chart.touching.empty()) end = std::min(end, chart.touching.front());
  const double turned = quarter_turn_of(method, end);
  return std::min((1.0 - linear_margin) * end, (1.0 - turn_margin) * turned) / highest_frequency;
}

std::string advice(double linear_step) {
  if (linear_step == 0.0) return "it has no stability window from 0 on";
  return fmt::format("by the linear criterion steps up to {:g} have a margin of {:g} %",
                     rounded_down(linear_step), 100.0 * linear_margin);
}

std::optional<double> safe_step(const method& method, const prepared_problem& system, double linear_step,
                                int threads) {
  if (!has_windows(method.letters()) || linear_step == 0.0 || system.frequency_bands().empty()) {
    return std::nullopt;
  }
  constexpr int most_tries = 12;
  constexpr int below = 3;  // rungs at which it must keep all, too
  const auto rung = [&](int n) { return rounded_down(linear_step * std::pow(1.0 - tried_margin, n)); };
  const auto keeps_all = [&](int n) {
    const judgement& found = system.judged(method, rung(n), threads);
    return found.holds() && found.lost == 0 && found.energy_error.largest < 1.0;
  };
  for (int n = 0; n < most_tries; ++n) {
    bool is_safe = true;
    for (int k = n - 1; is_safe && k <= n + below; ++k) is_safe = keeps_all(k);
    if (is_safe) return rung(n);
  }
  return std::nullopt;
}

std::optional<rival_judgement> loses_fewest(const method& method, const prepared_problem& system,
                                            const judgement& found, int threads) {
  if (found.holds() || found.verdict == step_verdict::not_tried || system.heat_bath().acts())
    return std::nullopt;
  const auto is_served = [&](const nysalt::method& other) {
    if (other.requires_quadratic_kinetic && !has_quadratic_kinetic(system.definition().system)) return false;
    try {
      system.require_served(other.letters());
      return true;
    } catch (const refusal&) {
      return false;
    }
  };
  std::vector<std::pair<double, const nysalt::method*>> candidates;  // window an evaluation
  for (const auto& [other, source] : classical_methods()) {
    const nysalt::word& word = other.letters();
    if (!has_windows(word) || word.stochastic_letters > 0 || !is_served(other)) continue;
    if (word.letters() == method.letters().letters() && other.coefficients() == method.coefficients()) {
      continue;
    }
    candidates.emplace_back(limit_of(other) / word.evaluations_per_step, &other);
  }
  constexpr std::size_t most = 5;
  std::ranges::stable_sort(candidates, std::greater(), &std::pair<double, const nysalt::method*>::first);
  std::optional<rival_judgement> best;
  for (const auto& [window, other] : std::span(candidates).first(std::min(most, candidates.size()))) {
    const double cost =
        static_cast<double>(other->letters().evaluations_per_step) / method.letters().evaluations_per_step;
    const judgement& one = system.judged(*other, found.step * cost, threads);
    if (one.trajectories == 0) continue;
    if (!best || one.share_lost() < best->found.share_lost()) best = {other->name(), one};
    if (best->found.lost == 0) break;
  }
  return best;
}

std::string in_words(const rival_judgement& rival) {
  return fmt::format("at equal cost {} at step {:g} loses {}", rival.method, rival.found.step,
                     rival.found.lost == 0 ? std::string("no trajectory")
                                           : fmt::format("the fewest trajectories, {:.2g} %",
                                                         100.0 * rival.found.share_lost()));
}

}  // namespace nysalt::program
