// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/trajectory_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "measured_trajectories.hpp"
#include "method_runs.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/detail/collectively.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/progress_of_share.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/langevin.hpp"

namespace nysalt::detail {

namespace {

constexpr std::size_t most_checks = 16;  // enough for the size of an error

void require_comparable(const model& system, const reference_value& reference,
                        std::span<const tabulated> methods, int parts, const trajectory_options& options) {
  if (parts > 0 && !reference.gives_noise()) {
    throw std::invalid_argument(
        sentence("trajectory_errors: the reference must have noise to share, got {}; take fine_paths",
                 reference.description()));
  }
  const double perturbation = options.perturbation.value_or(1.0);
  if (!(perturbation > 0.0) || !std::isfinite(perturbation)) {
    throw std::invalid_argument(sentence(
        "trajectory_errors: the perturbation of starts must be positive and finite, got {}", perturbation));
  }
  for (const tabulated& method : methods) make_stepper(system, method, options.step, counter_noise(0));
}

void require_measurable(const model& system, std::span<const error_measure> measures) {
  for (const error_measure& measure : measures) {
    if (measure.dimension == 0 || measure.dimension == system.size()) continue;
    throw std::invalid_argument(
        sentence("trajectory_errors: the {} error must be of systems of {} degrees of freedom, as {} has, "
                 "got {}; make the measure of the system that is stepped",
                 measure.name, system.size(), describe(system), measure.dimension));
  }
}

/// Trajectories first .. first + count - 1, whose starts are in the lanes of T; what is found is put into
/// their places, measure by measure.
struct comparison {
  const model& system;
  const reference_value& reference;
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

std::vector<trajectory_errors_result> trajectory_errors(const model& system, const reference_value& reference,
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
