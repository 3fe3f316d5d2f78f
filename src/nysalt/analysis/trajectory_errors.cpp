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
#include "nysalt/detail/divergence.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/langevin.hpp"
#include "trajectory_runs.hpp"

namespace nysalt {

void require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                  std::size_t measures) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(fmt::format(
        "trajectory_errors: trajectories and steps must be at least 1, got {} trajectories of {} steps",
        options.trajectories, options.steps));
  }
  const std::size_t references = options.perturbation ? 3 : 2;
  const double intervals = static_cast<double>(methods + references) * options.threads * default_lanes;
  const double numbers = intervals * static_cast<double>(steps_between_checks) * static_cast<double>(width);
  const std::size_t scored = methods + (options.null_model ? 1 : 0);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(scored * measures);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: samples must fit into memory, got {} trajectories with {} numbers a "
                    "sample, on {} threads; take fewer",
                    options.trajectories, width, options.threads));
  }
}

method_error error_of_runs(const std::vector<run_score>& runs, const error_measure& measure,
                           std::span<const double> sizes) {
  method_error result;
  std::vector<double> scores;
  for (const auto& run : runs) {
    if (run.diverged_at) result.diverged_at.push_back({std::ssize(scores), *run.diverged_at});
    scores.push_back(run.value);
  }
  result.diverged = std::ssize(result.diverged_at);
  result.error = measure.average(scores, sizes);
  result.of_each = measure.parts(scores, sizes);
  result.spread = {.largest = tail_of(scores), .median = {}, .quantiles = {}};
  result.own = measure.of_each(scores, sizes);
  const auto own = sorted_numbers(result.own);
  result.spread.median = median_and_error(own);
  for (std::size_t i = 0; i < shown_quantiles.size(); ++i) {
    result.spread.quantiles[i] = quantile(own, shown_quantiles[i]);
  }
  return result;
}

}  // namespace nysalt

namespace nysalt::detail {

measured_trajectories::measured_trajectories(std::size_t methods, std::size_t trajectories,
                                             std::size_t checked, bool null, std::size_t perturbed)
    : runs(methods, std::vector<run_score>(trajectories)),
      checks(checked),
      null_model(null ? trajectories : 0),
      predictable_until(perturbed),
      sizes(trajectories),
      signs(trajectories) {}

void measured_trajectories::gather(const shard& own) {
  for (auto& of_method : runs) own.gather(of_method);
  if (!null_model.empty()) own.gather(null_model);
  own.gather(sizes);
  own.gather(signs);
  broadcast(own.ranks(), checks);
  broadcast(own.ranks(), predictable_until);
}

trajectory_errors_result measured_trajectories::summary(const error_measure& measure,
                                                        const std::string& reference) const {
  const bool is_nothing = measure.relative_to && !(measure.unit(sizes) > 0.0);
  const auto differs = [&](double sign) { return sign != signs.front(); };
  if (is_nothing || std::ranges::any_of(signs, differs)) throw std::invalid_argument(measure.no_scale);
  trajectory_errors_result result;
  for (const auto& of_method : runs) result.methods.push_back(error_of_runs(of_method, measure, sizes));
  result.unit = measure.unit(sizes);
  if (!measure.needs_reference) return result;
  result.reference_error = measure.average(checks, sizes);
  result.reference = reference;
  if (!null_model.empty()) result.null_model = measure.average(null_model, sizes);
  if (!predictable_until.empty()) result.predictable_until = median(predictable_until);
  return result;
}

namespace {

constexpr std::size_t most_checks = 16;  // enough for the size of an error

void require_comparable(const model& system, const reference& reference, std::span<const tabulated> methods,
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
  for (const tabulated& method : methods) make_stepper(system, method, options.step, counter_noise(0));
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

/// Trajectories first .. first + count - 1, whose starts are in the lanes of T; what is found is put into
/// their places, measure by measure.
struct comparison {
  const model& system;
  const nysalt::reference& reference;
  const initial_states& ensemble;
  std::span<const tabulated> methods;
  std::span<const error_measure> measures;
  const trajectory_options& options;
  std::size_t checks;
  std::size_t perturbed;
  int parts;
  sample_weights weights;

  template <class T>
  void follow(std::int64_t first, int n, std::vector<measured_trajectories>& found) const {
    const model own = own_copy(system);
    const auto start = sound_starts<T>(own, ensemble, options.seed, first, n);
    const auto of_block = [&](std::size_t wanted) {
      return static_cast<int>(std::clamp<std::int64_t>(static_cast<std::int64_t>(wanted) - first, 0, n));
    };
    method_runs<T> block(own, reference, methods, options.step, measures, start, n,
                         {of_block(checks), of_block(perturbed), options.perturbation, options.null_model},
                         {parts, options.seed, first}, weights);
    block.run(options.steps);
    block.reference().require_sound(first);
    for (std::size_t i = 0; i < measures.size(); ++i) {
      for (int k = 0; k < n; ++k) {
        const auto slot = static_cast<std::size_t>(first + k);
        measured_trajectories& by_measure = found[i];
        for (std::size_t method = 0; method < methods.size(); ++method) {
          by_measure.runs[method][slot] = block.score(i, method, k);
        }
        if (slot < checks) by_measure.checks[slot] = block.reference().finer_error(i, k);
        if (slot < perturbed) by_measure.predictable_until[slot] = block.reference().predictable_until(i, k);
        if (options.null_model) by_measure.null_model[slot] = block.reference().null_error(i, k);
        by_measure.sizes[slot] = block.reference().size(i, k);
        by_measure.signs[slot] = block.reference().sign(i, k);
      }
    }
  }
};

}  // namespace

int parts_of_noise(const model& system, std::span<const tabulated> methods) {
  if (system.bath().sigma() == 0.0) return 0;
  int parts = 0;
  for (const tabulated& method : methods) {
    const int of_method = intervals_of_noise(method.letters(), method.coefficients()).parts;
    parts = parts == 0 ? of_method : std::lcm(parts, std::max(of_method, 1));
  }
  return parts;
}

std::vector<trajectory_errors_result> trajectory_errors(const model& system, const reference& reference,
                                                        const initial_states& ensemble,
                                                        std::span<const tabulated> methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options) {
  if (measures.empty())
    throw std::invalid_argument("trajectory_errors: measures must be one or more, got none");
  const communicator& ranks = *options.ranks;
  const shard own(options.trajectories, ranks);
  const auto trajectories = static_cast<std::size_t>(options.trajectories);
  const std::size_t checks = std::min(trajectories, most_checks);
  const std::size_t perturbed = options.perturbation ? checks : 0;
  comparison compared{system,  reference, ensemble,  methods, measures,
                      options, checks,    perturbed, 0,       sample_weights(options.steps)};
  std::vector<measured_trajectories> found;
  const auto follow_own = [&](std::int64_t block, int n) {
    if (system.facts().in_lanes) return compared.follow<lanes>(own.first() + block, n, found);
    compared.follow<double>(own.first() + block, n, found);
  };
  collectively(ranks, [&] {
    require_room(options, methods.size(), joined_measures(measures).width(), measures.size());
    compared.parts = parts_of_noise(system, methods);
    require_comparable(system, reference, methods, compared.parts, options);
    require_measurable(system, measures);
    if (options.horizon) compared.weights = sample_weights(options.step, options.steps, *options.horizon);
    found.assign(measures.size(), {methods.size(), trajectories, checks, options.null_model, perturbed});
    for_each_block(own.count(), system.facts().in_lanes ? default_lanes : 1, options.threads, follow_own,
                   progress_of_share(ranks, own.count(), options.trajectories, options.progress));
  });
  for (auto& by_measure : found) by_measure.gather(own);

  std::vector<trajectory_errors_result> results;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    results.push_back(
        found[i].summary(measures[i], measures[i].needs_reference ? reference.description() : ""));
    auto& of_reference = results.back().reference_error;
    if (compared.parts > 0 && of_reference) of_reference->mean *= error_over_difference;
  }
  const auto first = ensemble(options.seed, 0);
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const auto evaluations = evaluations_of_run(system, methods[method], options.step, options.steps, first);
    for (auto& by_measure : results) {
      by_measure.methods[method].evaluations_per_time = static_cast<double>(evaluations) / time;
    }
  }
  return results;
}

}  // namespace nysalt::detail
