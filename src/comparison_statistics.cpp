// SPDX-License-Identifier: BSL-1.0
// The metrics that compare laws, not paths: distribution and autocovariance.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "checks.hpp"
#include "comparison.hpp"
#include "nysalt/analysis/acf_error.hpp"
#include "nysalt/analysis/total_variation.hpp"
#include "seeds.hpp"

namespace nysalt::program {

namespace {

constexpr int references = 4;  // independent ensembles: six pairs for the floor

std::vector<histogram> histograms_of(std::span<const gathered_statistics> all) {
  std::vector<histogram> result;
  for (const auto& one : all) result.push_back(*one.histogram);
  return result;
}

/// Of one ensemble from the law of several: the mean over these.
estimate distance_to(const gathered_statistics& its, std::span<const gathered_statistics> others) {
  if (its.histogram) {
    std::vector<std::vector<histogram>> groups;
    for (const auto& other : others) groups.push_back(other.histogram_of_groups);
    return mean_total_variation(its.histogram_of_groups, groups);
  }
  estimate result{0.0, 0.0};
  const auto share = 1.0 / static_cast<double>(others.size());
  for (const auto& other : others) {
    const acf_distance found = acf_error(*its.autocovariance, *other.autocovariance);
    result.mean += found.rms * share;
    result.standard_error += found.standard_error * share;
  }
  return result;
}

/// The mean distance over all pairs of ensembles of one law.
double floor_of(std::span<const gathered_statistics> all) {
  if (all.front().histogram) return sampling_floor(histograms_of(all));
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k, ++pairs) sum += distance_to(all[i], all.subspan(k, 1)).mean;
  }
  return sum / pairs;
}

}  // namespace

void comparison::require_sound_statistics() const {
  const bath& its = system_->its_bath();
  if (its.acts() && its.sigma() == 0.0) {
    refuse("the metric {} needs a temperature above 0: friction alone brings all to rest", command_.metric);
  }
  if (its.acts() && !its.has_temperature()) {
    refuse("the metric {} needs a temperature: a bath with noise and no friction heats without end",
           command_.metric);
  }
  if (!command_.range.empty() && command_.range.size() != 2) {
    refuse("--range takes two numbers, such as 0,1, got {}", command_.range.size());
  }
  if (command_.bins < 1 || command_.bins > 100'000) {
    refuse("--bins must be at least 1 and at most 100000, got {}", command_.bins);
  }
  if (!command_.range.empty()) {
    const equal_bins bins{command_.range[0], command_.range[1], static_cast<int>(command_.bins)};
    if (!(bins.low < bins.high && std::isfinite(bins.width()))) {
      refuse("--range takes LOW,HIGH with LOW below HIGH, got {},{}", bins.low, bins.high);
    }
  }
  require_positive("--longest-lag", command_.longest_lag);
}

/// Autocovariances take some 50 lags, whatever the step: a product a lag and sample is all their cost.
statistics_plan comparison::statistics_at(double step) const {
  statistics_plan plan{.trajectories = plan_at(step), .every = 1, .first = 0, .bins = {}, .lags = {}};
  if (command_.metric == "distribution") {
    plan.bins = bins_;
    return plan;
  }
  const std::int64_t longest = steps_within("--longest-lag", command_.longest_lag, step);
  constexpr std::int64_t enough = 50;
  plan.every = std::max<std::int64_t>(1, longest / enough);
  plan.lags = static_cast<int>(longest / plan.every);
  if (*plan.lags < plan.trajectories.steps / plan.every) return plan;
  refuse("--longest-lag {} is not shorter than --horizon {}: take a longer horizon", command_.longest_lag,
         command_.horizon);
}

/// The same for all steps.
void comparison::prepare_bins() {
  if (command_.metric != "distribution" || bins_) return;
  std::array range{0.0, 0.0};
  if (command_.range.empty()) {
    range = system_->range_of_starts(plan_at(rows_.front().step), command_.observable);
    if (!(range[0] < range[1])) {
      refuse("the observable {} is {} at all starts: say the --range of its histogram", command_.observable,
             range[0]);
    }
  } else {
    range = {command_.range[0], command_.range[1]};
  }
  bins_ = equal_bins{range[0], range[1], static_cast<int>(command_.bins)};
}

/// Else all laws would be the same: none of them is seen.
void comparison::require_samples_in_range(std::span<const gathered_statistics> all) const {
  for (const auto& its : all) {
    if (!its.histogram) return;
    const auto inside = its.histogram->counts().subspan(1, static_cast<std::size_t>(bins_->count));
    if (std::ranges::any_of(inside, [](std::int64_t n) { return n > 0; })) return;
  }
  refuse("--range {},{} holds no {} of the reference, whose mean is {:g}: take a range about it", bins_->low,
         bins_->high, command_.observable, all.front().mean.mean);
}

/// Their trajectories have numbers of their own, hence starts and noise of their own. The law does not depend
/// on the step of those who are compared with it: one set serves all, at the smallest.
std::vector<gathered_statistics> comparison::references_at(double step) {
  if (command_.metric == "distribution" && !reference_statistics_.empty()) {
    return reference_statistics_.begin()->second;
  }
  std::vector<gathered_statistics> all;
  for (int k = 0; k < references; ++k) {
    statistics_plan plan = statistics_at(step);
    plan.trajectories.seed = seed_for(role::reference, common_.seed);
    plan.first = k * plan.trajectories.count;
    shown_.part(fmt::format("reference {} of {} at step {:g}", k + 1, references, step));
    all.push_back(system_->reference_statistics(plan, command_.observable, command_.learning.fine_step,
                                                shown_.counter(plan.trajectories.count)));
    if (all.back().lost.empty()) continue;
    const auto [trajectory, at] = all.back().lost.front();
    refuse("trajectory {} of the reference diverged at step {}: take a smaller --fine-step or another system",
           trajectory, at);
  }
  require_samples_in_range(all);
  json used{{"step_size", step},
            {"reference", system_->reference_of_statistics(step, command_.learning.fine_step)},
            {"ensembles", references},
            {"mean", all.front().mean.mean},
            {"error", floor_of(all)}};
  if (all.front().histogram) {
    used["kinetic_temperature"] = all.front().kinetic_temperature.mean;
    used["half_step_kinetic_temperature"] = all.front().half_step_kinetic_temperature.mean;
  }
  references_.push_back(used);
  reference_statistics_[step] = all;
  return all;
}

void comparison::measure_statistics_at(double step, const std::vector<row*>& group) {
  prepare_bins();
  const std::vector<row*> measured = usable(group, plan_at(step));
  if (measured.empty()) return;
  const auto all = references_at(step);
  const double floor = floor_of(all);
  for (row* its : measured) {
    const statistics_plan plan = statistics_at(step);
    shown_.part(fmt::format("{} at step {:g}", its->method, its->nominal));
    its->statistics = system_->statistics(*its->coefficients, plan, command_.observable,
                                          shown_.counter(plan.trajectories.count));
    const auto evaluations =
        static_cast<double>(system_->count_evaluations(*its->coefficients, plan.trajectories));
    its->evaluations_per_time = evaluations / (static_cast<double>(plan.trajectories.steps) * step);
    its->diverged = std::ssize(its->statistics->lost);
    its->floor = floor;
    if (its->statistics->counted == 0) {
      const auto earliest = std::ranges::min(its->statistics->lost, {}, &lost_trajectory::step);
      its->reason = fmt::format("every trajectory diverged, the first of them at step {}", earliest.step);
      continue;
    }
    its->error = distance_to(*its->statistics, all);
  }
}

}  // namespace nysalt::program
