// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/trajectory_errors.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "trajectory_runs.hpp"

namespace nysalt {

void detail::require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                          std::size_t measures) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(fmt::format(
        "trajectory_errors: trajectories and steps must be at least 1, got {} trajectories of {} steps",
        options.trajectories, options.steps));
  }
  const std::size_t references = options.perturbation ? 3 : 2;
  const double intervals =
      static_cast<double>(methods + references) * options.execution.threads * pack<double>::lanes;
  const double numbers = intervals * static_cast<double>(steps_between_checks) * static_cast<double>(width);
  const std::size_t scored = methods + (options.null_model ? 1 : 0);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(scored * measures);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: samples must fit into memory, got {} trajectories with {} numbers a "
                    "sample, on {} threads; take fewer",
                    options.trajectories, width, options.execution.threads));
  }
}

}  // namespace nysalt

namespace nysalt::detail {

namespace {

/// Each rank has filled in its own trajectories, and all get all. The few that the reference is checked on
/// are in the first leaf.
void gather(measured_errors& found, const shard& share) {
  for (auto& of_method : found.methods) {
    share.gather(of_method.scores);
    share.gather(of_method.diverged_at);
  }
  if (!found.null_model.empty()) share.gather(found.null_model);
  share.gather(found.sizes);
  share.gather(found.signs);
  broadcast(share.ranks(), found.checks);
  broadcast(share.ranks(), found.predictable_until);
}

method_error error_of(const scores_of_method& runs, const error_measure& measure,
                      std::span<const double> sizes) {
  method_error result;
  for (std::size_t m = 0; m < runs.scores.size(); ++m) {
    if (runs.diverged_at[m]) {
      result.diverged_at.push_back({static_cast<std::int64_t>(m), *runs.diverged_at[m]});
    }
  }
  result.diverged = std::ssize(result.diverged_at);
  result.error = measure.average(runs.scores, sizes);
  result.of_each = measure.parts(runs.scores, sizes);
  result.own = measure.of_each(runs.scores, sizes);
  const auto own = sorted_numbers(result.own);
  result.spread = {.largest = tail_of(runs.scores), .median = median_and_error(own), .quantiles = {}};
  for (std::size_t i = 0; i < shown_quantiles.size(); ++i) {
    result.spread.quantiles[i] = quantile(own, shown_quantiles[i]);
  }
  return result;
}

/// Throws std::invalid_argument where what errors are relative to is 0, or a scale is of both signs.
trajectory_errors_result summary(const measured_errors& found, const error_measure& measure,
                                 const comparison& compared) {
  trajectory_errors_result result;
  result.unit = measure.unit(found.sizes);
  const auto differs = [&](double sign) { return sign != found.signs.front(); };
  if ((measure.relative_to && !(result.unit > 0.0)) || std::ranges::any_of(found.signs, differs)) {
    throw std::invalid_argument(measure.no_scale);
  }
  for (const auto& runs : found.methods) result.methods.push_back(error_of(runs, measure, found.sizes));
  if (!measure.needs_reference) return result;
  result.reference_error = measure.average(found.checks, found.sizes);
  if (compared.parts > 0) result.reference_error->mean *= error_over_difference;
  result.reference = compared.reference.description();
  if (!found.null_model.empty()) result.null_model = measure.average(found.null_model, found.sizes);
  if (!found.predictable_until.empty()) result.predictable_until = median(found.predictable_until);
  return result;
}

constexpr std::int64_t most_checks = 16;  // enough for the size of an error

void require_comparable(const model& system, const reference& reference, std::span<const method> methods,
                        int parts, const trajectory_options& options) {
  if (parts > 0 && !reference.gives_noise()) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: the reference must have noise to share, got {}; take fine_paths",
                    reference.description()));
  }
  const double perturbation = options.perturbation.value_or(1.0);
  if (!(perturbation > 0.0) || !std::isfinite(perturbation)) {
    throw std::invalid_argument(fmt::format(
        "trajectory_errors: the perturbation of starts must be positive and finite, got {}", perturbation));
  }
  for (const method& method : methods) make_stepper(system, method, options.step, counter_noise(0));
}

void require_measurable(const model& system, std::span<const error_measure> measures) {
  for (const error_measure& measure : measures) {
    if (measure.dimension == 0 || measure.dimension == system.size()) continue;
    throw std::invalid_argument(
        fmt::format("trajectory_errors: the {} error must be of systems of {} degrees of freedom, as {} has, "
                    "got {}; make the measure of the system that is stepped",
                    measure.name, system.size(), describe(system), measure.dimension));
  }
}

}  // namespace

int parts_of_noise(const model& system, std::span<const method> methods) {
  if (system.bath().sigma() == 0.0) return 0;
  int parts = 0;
  for (const method& method : methods) {
    const int of_method = intervals_of_noise(method.letters(), method.coefficients()).parts;
    parts = parts == 0 ? of_method : std::lcm(parts, std::max(of_method, 1));
  }
  return parts;
}

std::vector<trajectory_errors_result> trajectory_errors(const model& system, const reference& reference,
                                                        const initial_states& ensemble,
                                                        std::span<const method> methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options) {
  if (measures.empty())
    throw std::invalid_argument("trajectory_errors: measures must be one or more, got none");
  const shard share(options.trajectories, *options.execution.ranks);
  const std::int64_t checks = std::min(options.trajectories, most_checks);
  comparison compared{.reference = reference,
                      .methods = methods,
                      .measures = measures,
                      .options = options,
                      .checked = checks,
                      .perturbed = options.perturbation ? checks : 0,
                      .parts = 0,
                      .weights = sample_weights(options.steps),
                      .begins = {0}};
  for (const auto& measure : measures) compared.begins.push_back(compared.width() + measure.width);
  std::vector<measured_errors> found(measures.size());
  collectively(share.ranks(), [&] {
    require_room(options, methods.size(), compared.width(), measures.size());
    compared.parts = parts_of_noise(system, methods);
    require_comparable(system, reference, methods, compared.parts, options);
    require_measurable(system, measures);
    if (options.horizon) compared.weights = sample_weights(options.step, options.steps, *options.horizon);
    const auto all = static_cast<std::size_t>(options.trajectories);
    for (auto& by_measure : found) {
      by_measure.methods.assign(methods.size(), {std::vector<double>(all), {}});
      for (auto& of_method : by_measure.methods) of_method.diverged_at.resize(all);
      by_measure.checks.resize(static_cast<std::size_t>(checks));
      by_measure.null_model.resize(options.null_model ? all : 0);
      by_measure.predictable_until.resize(static_cast<std::size_t>(compared.perturbed));
      by_measure.sizes.resize(all);
      by_measure.signs.resize(all);
    }
  });
  with_scalar_of(system, [&]<class T>(T) {
    const auto follow = [&](const model& own, std::int64_t first, int count) {
      const block_of_starts<T> block{own, sound_starts<T>(own, ensemble, options.seed, first, count), first,
                                     count};
      compared_block<T> runs(compared, block);
      runs.run();
      runs.store(found);
    };
    for_each_lane_block(system, share, lanes_in<T>, options.execution, follow);
  });

  const auto start = ensemble(options.seed, 0);
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  std::vector<trajectory_errors_result> results;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    gather(found[i], share);
    results.push_back(summary(found[i], measures[i], compared));
  }
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const auto evaluations = evaluations_of_run(system, methods[method], options.step, options.steps, start);
    for (auto& by_measure : results) {
      by_measure.methods[method].evaluations_per_time = static_cast<double>(evaluations) / time;
    }
  }
  return results;
}

}  // namespace nysalt::detail
