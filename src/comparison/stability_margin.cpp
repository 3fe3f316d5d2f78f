// SPDX-License-Identifier: BSL-1.0
#include "stability_margin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "nysalt/derivatives/near_resonance.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "stability.hpp"

namespace nysalt::program {

double known_frequencies::highest() const {
  double result = 0.0;
  for (const auto& band : bands) result = std::max(result, band.high);
  return result;
}

std::string known_frequencies::source() const {
  if (highest() == declared) return "declared";
  if (highest() == of_law) return "met by rare starts";
  if (are_of_motion && !(along_starts && highest() == *along_starts))
    return "seen along the motion from some starts";
  return fmt::format("seen along {} starts", starts);
}

namespace {

void raise(std::vector<frequency_band>& bands, double highest) {
  const auto last = std::max_element(bands.begin(), bands.end(),
                                     [](const auto& a, const auto& b) { return a.high < b.high; });
  last->high = std::max(last->high, highest);
}

}  // namespace

known_frequencies frequencies_of(const prepared_problem& system) {
  known_frequencies known{system.frequency_bands(), highest_frequency(system), system.frequency_of_law(), {}};
  if (known.bands.empty()) known.bands = system.bands_along_motion();
  known.are_of_motion = !known.bands.empty() && !known.declared;
  if (known.bands.empty()) known.bands.push_back({0.0, known.of_law});
  raise(known.bands, known.of_law);
  return known;
}

known_frequencies frequencies_along_starts(const prepared_problem& system, std::uint64_t seed,
                                           std::uint64_t count) {
  constexpr double accuracy = 0.02;  // the estimate's 1 %, rounded outwards, and some room
  known_frequencies known = frequencies_of(system);
  known.along_starts = system.frequency_along_starts(seed, count);
  known.starts = count;
  if (known.along_starts > known.highest() * (1.0 + accuracy)) raise(known.bands, *known.along_starts);
  return known;
}

bool judged_step::is_stable() const {
  return std::ranges::all_of(bands, [](const auto& band) { return band.stable; });
}

double judged_step::margin() const {
  double least = 1.0;
  for (const auto& band : bands) least = std::min(least, band.margin);
  return least;
}

namespace {

/// A nonlinear system does not keep to its bands to the last digit.
std::optional<double> touching_point(const stability_chart& chart, double low, double high) {
  constexpr double room = 0.02;
  for (const double z : chart.touching) {
    if (low * (1.0 - room) <= z && z <= high * (1.0 + room)) return z;
  }
  return std::nullopt;
}

/// The first z below `end` at which a step turns an oscillator by a quarter, or the end.
double quarter_turn_of(const tabulated& method, double end) {
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

double linear_step_of(const tabulated& method, const stability_chart& chart, double highest_frequency) {
  if (chart.windows.empty() || chart.windows.front().low > 0.0 || highest_frequency == 0.0) return 0.0;
  double end = chart.windows.front().high;
  if (!chart.touching.empty()) end = std::min(end, chart.touching.front());
  const double turned = quarter_turn_of(method, end);
  return std::min((1.0 - linear_margin) * end, (1.0 - turn_margin) * turned) / highest_frequency;
}

}  // namespace

judged_step judge(const tabulated& method, const stability_chart& chart, const known_frequencies& frequencies,
                  double step) {
  judged_step result{{},
                     gaps_below(chart.windows, step * frequencies.highest()),
                     stable_steps(chart.windows, frequencies.bands),
                     linear_step_of(method, chart, frequencies.highest())};
  for (const auto& band : frequencies.bands) {
    const double low = step * band.low;
    const double high = step * band.high;
    result.bands.push_back({band, is_stable(chart.windows, low, high),
                            stability_margin(chart.windows, low, high), touching_point(chart, low, high)});
  }
  return result;
}

namespace {

/// To three digits.
double rounded_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::floor(x / unit) * unit;
}

}  // namespace

std::string advice(const judged_step& judged) {
  if (judged.linear_step == 0.0) return "it has no stability window from 0 on";
  return fmt::format("by the linear criterion steps up to {:g} have a margin of {:g} %",
                     rounded_down(judged.linear_step), 100.0 * linear_margin);
}

namespace {

/// 192 trajectories of 20,000 steps, or fewer steps where these are expensive.
trajectories_plan plan_of_trial(const tabulated& method, const prepared_problem& system, double step,
                                std::int64_t most_steps, std::uint64_t seed, int threads) {
  constexpr std::int64_t trajectories = 192;
  constexpr std::int64_t shortest = 100;
  constexpr std::int64_t work = 2'000'000'000;  // coordinates times evaluations, some seconds
  const std::int64_t each = trajectories * method.letters().evaluations_per_step * system.dimension();
  const std::int64_t steps = std::clamp<std::int64_t>(work / std::max<std::int64_t>(1, each), shortest,
                                                      std::max(shortest, most_steps));
  return {step, steps, trajectories, seed, threads};
}

constexpr std::int64_t usual_steps = 20'000;

}  // namespace

trial_result try_step(const tabulated& method, const prepared_problem& system, double step,
                      std::uint64_t seed, int threads) {
  return system.trial(method, plan_of_trial(method, system, step, usual_steps, seed, threads));
}

std::optional<double> safe_step(const tabulated& method, const prepared_problem& system,
                                const judged_step& judged, std::optional<double> failed, std::uint64_t seed,
                                int threads) {
  if (!has_windows(method.letters()) || judged.linear_step == 0.0 || system.frequency_bands().empty()) {
    return std::nullopt;
  }
  constexpr double ratio = 1.0 - tried_margin;
  constexpr int most_tries = 12;
  constexpr int below = 3;  // rungs that must pass, too
  std::vector<double> steps;
  for (int n = -1; n < most_tries + below; ++n) {
    steps.push_back(rounded_down(judged.linear_step * std::pow(ratio, n)));
  }
  std::vector<std::optional<trial_result>> tried(steps.size());
  const auto at = [&](std::size_t n) -> const trial_result& {
    if (!tried[n]) tried[n] = try_step(method, system, steps[n], seed, threads);
    return *tried[n];
  };
  for (std::size_t n = 1; n + below < steps.size(); ++n) {
    if (failed && steps[n - 1] >= *failed) continue;
    bool passes = at(n - 1).passed() && at(n).relative_deviation < 1.0;
    for (std::size_t k = n; passes && k <= n + below; ++k) passes = at(k).passed();
    if (passes) return steps[n];
  }
  return std::nullopt;
}

json to_json(const trial_result& trial) {
  json result{{"trajectories", trial.trajectories},
              {"steps", trial.steps},
              {"passed", trial.passed()},
              {"diverged", trial.diverged},
              {"unconfined", trial.unconfined},
              {"first_diverged", nullptr},
              {"largest_deviation", nullptr},
              {"largest_deviation_in_first_tenth", nullptr},
              {"largest_relative_deviation", nullptr},
              {"report", trial.report()}};
  if (trial.lost) {
    result["first_diverged"] = {{"trajectory", trial.lost->trajectory}, {"step", trial.lost->step}};
  }
  if (trial.energy_was_watched) {
    result["largest_deviation"] = trial.deviation;
    result["largest_deviation_in_first_tenth"] = trial.first_deviation;
    result["largest_relative_deviation"] = trial.relative_deviation;
  }
  return result;
}

std::optional<std::string> failed_trial(const std::string& name, const tabulated& method,
                                        const prepared_problem& system, double step, std::int64_t steps,
                                        std::uint64_t seed, int threads) {
  if (has_windows(method.letters()) && !system.frequency_bands().empty()) return std::nullopt;
  const auto trial =
      system.trial(method, plan_of_trial(method, system, step, std::min(steps, usual_steps), seed, threads));
  const std::string objection = trial.objection();
  if (objection.empty()) return std::nullopt;
  return fmt::format("{} at step {:g}: {}; take a smaller step", name, step, objection);
}

namespace {

const judged_band& worst_of(const judged_step& judged) {
  return *std::ranges::min_element(judged.bands, {}, &judged_band::margin);
}

std::string not_stable(const std::string& name, const prepared_problem& system, double step,
                       const judged_step& judged, const std::string& source) {
  const frequency_band& band = worst_of(judged).band;
  return fmt::format("{} is not linearly stable at step {:g} for the frequencies {:g} to {:g} ({}) of {}; {}",
                     name, step, band.low, band.high, source, system.description(), advice(judged));
}

/// Steps are tried downwards.
std::string magnified(const std::string& name, const tabulated& method, const prepared_problem& system,
                      double step) {
  const auto guard = system.guard(method.letters());
  const auto objection = guard.objection(method.letters(), method.coefficients(), step);
  if (objection.empty()) return {};
  std::string text = fmt::format("{} at step {:g}: {}", name, step, objection);
  constexpr int tries = 40;
  double smaller = step;
  for (int i = 0; i < tries; ++i) {
    smaller = rounded_down(0.95 * smaller);
    if (guard.admits(method.letters(), method.coefficients(), smaller))
      return text + fmt::format("; at step {:g} it does not", smaller);
  }
  return text;
}

}  // namespace

std::optional<std::string> instability(const std::string& name, const tabulated& method,
                                       const prepared_problem& system, double step) {
  if (method.letters().has_own_letters()) {
    const auto guard = system.guard_of_parts(method.letters());
    if (!guard) return std::nullopt;  // a trial run says more
    const std::string objection = guard->objection(method.letters(), method.coefficients(), step);
    if (objection.empty()) return std::nullopt;
    return fmt::format("{} at step {:g}: {}; take another step", name, step, objection);
  }
  if (has_rotation(method.letters())) {
    const std::string text = magnified(name, method, system, step);
    return text.empty() ? std::nullopt : std::optional(text);
  }
  const auto known = frequencies_of(system);
  const auto judged = judge(method, chart_of(method), known, step);
  if (judged.is_stable()) return std::nullopt;
  return not_stable(name, system, step, judged, known.source());
}

std::optional<std::string> stability_warning(const std::string& name, const tabulated& method,
                                             const prepared_problem& system, double step, std::int64_t steps,
                                             std::uint64_t seed) {
  if (!has_windows(method.letters())) return std::nullopt;
  const auto chart = chart_of(method);
  if (!judge(method, chart, frequencies_of(system), step).is_stable())
    return std::nullopt;  // instability() says why
  constexpr std::uint64_t some = 16;
  const auto known = frequencies_along_starts(system, seed, some);
  const auto judged = judge(method, chart, known, step);
  if (!judged.is_stable()) return not_stable(name, system, step, judged, known.source());
  const auto& worst = worst_of(judged);
  if (worst.margin < wanted_margin) {
    return fmt::format(
        "{} at step {:g} is {:.3g} % from the end of a stability window, at the frequencies {:g} to {:g} "
        "({}) "
        "of {}; {}",
        name, step, 100.0 * worst.margin, worst.band.low, worst.band.high, known.source(),
        system.description(), advice(judged));
  }
  for (const auto& band : judged.bands) {
    if (!band.touching) continue;
    return fmt::format(
        "{} at step {:g}: among its frequencies {:g} to {:g} is z = {:.4g}, where two stability windows "
        "touch, and errors of nonlinear motion add up; {}",
        name, step, band.band.low, band.band.high, *band.touching, advice(judged));
  }
  if (steps > long_run && !system.heat_bath().acts()) {
    const auto near = near_resonance(method.letters(), method.coefficients(), known.bands, step);
    if (near) return fmt::format("{} at step {:g}: {}", name, step, in_words(*near));
  }
  return std::nullopt;
}

}  // namespace nysalt::program
