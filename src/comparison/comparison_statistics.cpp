// SPDX-License-Identifier: BSL-1.0
// The metrics that compare distributions, not paths: distribution and autocovariance.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "checks.hpp"
#include "comparison.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "seeds.hpp"

namespace nysalt::program {

namespace {

constexpr int references = 4;  // independent ensembles: six pairs for the floor

std::vector<histogram> histograms_of(std::span<const gathered_statistics> all) {
  std::vector<histogram> result;
  for (const auto& one : all) result.push_back(*one.histogram);
  return result;
}

/// The distance of one ensemble from the distribution of several: the mean over these.
estimate distance_to(const gathered_statistics& ensemble, std::span<const gathered_statistics> others) {
  if (ensemble.histogram) {
    std::vector<std::vector<histogram>> groups;
    for (const auto& other : others) groups.push_back(other.histogram_of_groups);
    return mean_total_variation(ensemble.histogram_of_groups, groups);
  }
  estimate result{0.0, 0.0};
  const auto share = 1.0 / static_cast<double>(others.size());
  for (const auto& other : others) {
    const autocovariance::distance found = acf_error(*ensemble.autocovariance, *other.autocovariance);
    result.mean += found.rms * share;
    result.standard_error += found.standard_error * share;
  }
  return result;
}

/// The mean distance over all pairs of ensembles of one distribution.
double floor_of(std::span<const gathered_statistics> all) {
  if (all.front().histogram) return sampling_floor(histograms_of(all));
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k, ++pairs) sum += distance_to(all[i], all.subspan(k, 1)).mean;
  }
  return sum / pairs;
}

/// Of independent ensembles, with less noise than each has; they share their x.
drawn_law mean_law(std::span<const gathered_statistics> all) {
  drawn_law result = drawn(all.front());
  const double share = 1.0 / static_cast<double>(all.size());
  const auto add = [&](double& to, double value, bool is_first) {
    to = (is_first ? 0.0 : to) + share * value;
  };
  double variance = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const drawn_law law = drawn(all[k]);
    for (std::size_t i = 0; i < law.y.size(); ++i) add(result.y[i], law.y[i], k == 0);
    add(result.mean.mean, law.mean.mean, k == 0);
    variance += std::pow(share * law.mean.standard_error, 2.0);
    if (!law.kinetic_temperature) continue;
    add(*result.kinetic_temperature, *law.kinetic_temperature, k == 0);
    add(*result.half_step_kinetic_temperature, *law.half_step_kinetic_temperature, k == 0);
  }
  result.mean.standard_error = std::sqrt(variance);
  return result;
}

}  // namespace

void comparison::require_sound_statistics() const {
  const bath& heat_bath = system_->heat_bath();
  const auto of_law = std::ranges::find_if(metrics_, &asked_metric::is_of_law);
  if (heat_bath.acts() && heat_bath.sigma() == 0.0) {
    refuse(
        "the metric {}: the temperature must be > 0, got 0, at which friction stops all motion; give {} or "
        "{}",
        of_law->name, spelled("temperature"), spelled("sigma"));
  }
  if (heat_bath.acts() && !heat_bath.has_temperature()) {
    refuse(
        "the metric {}: the bath must have a temperature, got noise without friction, which heats without "
        "end; give {}",
        of_law->name, spelled("friction"));
  }
  const auto is_distribution = [](const asked_metric& one) { return one.name == "distribution"; };
  if (!options_.range.empty() && options_.range.size() != 2) {
    refuse_value("range", "must be two numbers, such as 0,1, got {}", options_.range.size());
  }
  const auto distributions = std::ranges::count_if(metrics_, is_distribution);
  if (!options_.range.empty() && distributions > 1) {
    refuse_value("range", "must come with one metric distribution, got {}; take one, or leave {} away",
                 distributions, spelled("range"));
  }
  if (options_.bins < 1 || options_.bins > 100'000) {
    refuse_value("bins", "must be at least 1 and at most 100000, got {}", options_.bins);
  }
  if (!options_.range.empty()) {
    const equal_bins bins{options_.range[0], options_.range[1], static_cast<int>(options_.bins)};
    if (!(bins.low < bins.high)) {
      refuse_value("range", "must be LOW,HIGH with LOW below HIGH, got {},{}", bins.low, bins.high);
    }
    if (!std::isfinite(bins.high - bins.low)) {
      refuse_value("range", "must have a finite width, got {},{}; take a narrower one", bins.low, bins.high);
    }
  }
  require_positive("longest_lag", options_.longest_lag);
}

/// Autocovariances take some 50 lags at any step: a product a lag and sample is all their cost.
statistics_plan comparison::statistics_at(std::size_t metric, double step) const {
  statistics_plan plan{.trajectories = plan_at(step)};
  if (metrics_[metric].name == "distribution") {
    plan.bins = bins_[metric];
    return plan;
  }
  const std::int64_t longest = steps_within("longest_lag", options_.longest_lag, step);
  constexpr std::int64_t enough = 50;
  plan.every = std::max<std::int64_t>(1, longest / enough);
  plan.lags = static_cast<int>(longest / plan.every);
  if (*plan.lags < plan.trajectories.steps / plan.every) return plan;
  refuse_value("longest_lag", "must be shorter than {} {}, got {}; take a longer horizon", spelled("horizon"),
               horizon_, options_.longest_lag);
}

/// The same for all steps.
void comparison::prepare_bins(std::size_t metric) {
  if (metrics_[metric].name != "distribution" || bins_[metric]) return;
  const std::string& observable = metrics_[metric].observable;
  std::array<double, 2> range{};
  if (options_.range.empty()) {
    const auto values = system_->values_at_starts(plan_at(rows_.front().step), observable);
    const auto [low, high] = std::ranges::minmax(values);
    range = {low, high};
    if (!(range[0] < range[1])) {
      refuse(
          "the observable {} must differ between initial states, got {} at all; give the {} of its histogram",
          observable, range[0], spelled("range"));
    }
  } else {
    range = {options_.range[0], options_.range[1]};
  }
  bins_[metric] = equal_bins{range[0], range[1], static_cast<int>(options_.bins)};
}

/// Otherwise all distributions would be the same: none of them is seen.
void comparison::require_samples_in_range(std::size_t metric,
                                          std::span<const gathered_statistics> all) const {
  const auto& bins = bins_[metric];
  if (!bins) return;
  for (const auto& ensemble : all) {
    const auto inside = ensemble.histogram->counts().subspan(1, static_cast<std::size_t>(bins->count));
    if (std::ranges::any_of(inside, [](std::int64_t n) { return n > 0; })) return;
  }
  refuse_value(
      "range",
      "must hold values of {} of the reference, whose mean is {:g}, got {},{}; take a range about the "
      "mean",
      metrics_[metric].observable, all.front().mean.mean, bins->low, bins->high);
}

/// The trajectories of references have numbers of their own, hence starts and noise of their own. References
/// are sampled when the methods are at that step: the floor is of as many samples.
gathered_statistics comparison::reference(std::size_t metric, double step, int number, int finer) {
  statistics_plan plan = statistics_at(metric, step);
  plan.trajectories.seed = seed_for(role::reference, common_.seed);
  plan.first = number * plan.trajectories.count;
  plan.finer = finer;
  shown_.part(fmt::format("reference {} of {} at step {:g}", number + 1, references + 1, step),
              finer * work_of_reference());
  auto found = system_->reference_statistics(plan, metrics_[metric].observable, options_.learning.fine_step,
                                             shown_.counter(plan.trajectories.count));
  if (found.lost.empty()) return found;
  const auto [trajectory, at] = found.lost.front();
  refuse(
      "cannot sample the reference: its trajectory {} diverged at step {}; take a smaller {} or another "
      "system",
      trajectory, at, spelled("fine_step"));
}

const std::vector<gathered_statistics>& comparison::references_at(std::size_t metric, double step) {
  if (!references_.empty()) return references_;
  for (int k = 0; k < references; ++k) references_.push_back(reference(metric, step, k, 1));
  require_samples_in_range(metric, references_);
  return references_;
}

/// What stays where it starts: the distribution is the initial one, and nothing is forgotten. Empty where the
/// initial states have that distribution already, within their statistical error.
std::optional<double> comparison::null_model_of_law(std::size_t metric, double step, const drawn_law& law) {
  if (metrics_[metric].name == "acf") {
    double sum = 0.0;
    for (const double rho : law.y) sum += (1.0 - rho) * (1.0 - rho);
    return std::sqrt(sum / static_cast<double>(law.y.size() - 1));
  }
  statistics_plan frozen = statistics_at(metric, step);
  frozen.trajectories.steps = 0;
  frozen.trajectories.seed = seed_for(role::reference, common_.seed);
  std::vector<gathered_statistics> starts;
  double distance = 0.0;
  for (int k = 0; k < references; ++k) {
    frozen.first = (references + 1 + k) * frozen.trajectories.count;
    starts.push_back(system_->reference_statistics(frozen, metrics_[metric].observable, {}, {}));
    distance += distance_to(starts.back(), references_).mean / references;
  }
  constexpr double seen = 1.5;
  if (distance < seen * floor_of(starts)) return std::nullopt;
  return distance;
}

baseline comparison::baseline_of_law(std::size_t metric, double step) {
  const auto& all = references_at(metric, step);
  const auto finer = reference(metric, step, references, 2);
  baseline result{.reference = system_->reference_of_statistics(step, options_.learning.fine_step),
                  .reference_error = distance_to(finer, all).mean,
                  .floor = floor_of(all),
                  .law = mean_law(all)};
  result.null_model = null_model_of_law(metric, step, *result.law);
  return result;
}

measurement comparison::law_of(std::size_t metric, const row& line,
                               std::span<const gathered_statistics> all) {
  const statistics_plan plan = statistics_at(metric, line.step);
  shown_.part(fmt::format("{} at step {:g}", line.method, line.nominal),
              work_of_law(line.evaluations_per_time));
  const auto found = system_->statistics(*line.coefficients, plan, metrics_[metric].observable,
                                         shown_.counter(plan.trajectories.count));
  measurement one{.law = drawn(found)};
  one.lose(found.lost, plan.trajectories.count);
  if (found.counted > 0) one.value = distance_to(found, all);
  return one;
}

void comparison::measure_law(std::size_t metric, double step, const group& all, work_file& kept) {
  if (all.empty()) return;
  prepare_bins(metric);
  references_.clear();
  const std::string name = metrics_[metric].text();
  const std::string part = fmt::format("reference of {} at {}", name, step);
  if (kept.has(part)) shown_.skip(6.0 * work_of_reference());
  const auto read_reference = [](const json& text) {
    auto context = from_json<baseline>(text);
    if (!context.law) throw std::out_of_range("law");
    return context;
  };
  const auto read = [&](const json& text) { return measurement_from(text, options_.trajectories); };
  measured found{.against = kept.once(part, read_reference, [&] { return baseline_of_law(metric, step); })};
  for (const row* line : all) {
    const std::string line_part = fmt::format("{} of {} at {}", name, line->method, step);
    if (kept.has(line_part)) shown_.skip(work_of_law(line->evaluations_per_time));
    found.measurements.push_back(
        kept.once(line_part, read, [&] { return law_of(metric, *line, references_at(metric, step)); }));
  }
  take(metric, step, all, found);
}

}  // namespace nysalt::program
