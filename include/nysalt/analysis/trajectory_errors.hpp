// SPDX-License-Identifier: BSL-1.0
// Methods at one step against one reference, along many trajectories, by one measure or several.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <ranges>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/analysis/compared_block.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/analysis/trajectory_errors_result.hpp"
#include "nysalt/analysis/trajectory_options.hpp"
#include "nysalt/detail/ensemble_loop.hpp"
#include "nysalt/detail/progress_of_share.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/together.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// A vector, array or span of methods of one type.
template <class C>
concept Methods =
    std::ranges::contiguous_range<C> && std::ranges::sized_range<C> && Method<std::ranges::range_value_t<C>>;

/// In how many parts of a step methods need the noise of a path: 0 if the system is in no noisy bath.
template <SeparableSystem S, Method M>
int parts_of_noise(const S& system, std::span<const M> methods) {
  int parts = 0;
  if constexpr (HasBath<S>) {
    if (static_cast<const bath&>(system.bath()).sigma() == 0.0) return 0;
    for (const M& method : methods) {
      const int its = intervals_of_noise(word_of(method), method.coefficients()).parts;
      parts = parts == 0 ? its : std::lcm(parts, std::max(its, 1));
    }
  }
  return parts;
}

namespace detail {

template <class M, SeparableSystem S, class R>
void require_comparable(const S& system, const R& reference, std::span<const M> methods, int parts,
                        const trajectory_options& options) {
  if (parts > 0 && !PathReference<R, S>) {
    throw std::invalid_argument(
        sentence("trajectory_errors: the reference ({}) has no noise to share; take fine_paths",
                 reference.description()));
  }
  const double perturbation = options.perturbation.value_or(1.0);
  if (!(perturbation > 0.0) || !std::isfinite(perturbation)) {
    throw std::invalid_argument(sentence(
        "trajectory_errors: the perturbation of starts must be positive and finite, got {}", perturbation));
  }
  for (const M& method : methods) make_stepper(system, method, options.step, counter_noise(0));
}

}  // namespace detail

/// By each of several measures, in their order: runs the reference once along each trajectory, and every
/// method beside it, as many trajectories at a time as there are lanes; all measures look at the same runs.
/// In a bath all see the reference's noise, each in the parts of a step that its letters O cover. The
/// reference's own error is taken on the first 16 trajectories, along noisy paths with error_over_difference.
/// If no measure needs a reference, none runs but for its noise. Neither lanes, threads nor ranks change a
/// bit, nor does a measure those of another.
///
/// For the measures that need a reference, if the options ask for it:
///   null_model         the error of what stays as it was at the start, over all trajectories;
///   predictable_until  a second reference starts from q_i (1 + perturbation xi_i), p_i likewise, with normal
///                      xi and the same noise, on the first 16 trajectories. There a trajectory is
///                      predictable until the errors so far of that run exceed half of the null model's, by
///                      root mean squares (by means for averaging::mean), and do so to the end; this is the
///                      median. Infinite if that does not come to pass, so a longer horizon can tell more.
///
/// System, reference, ensemble and measures are used by several threads at once. Ranks share the trajectories
/// by whole leaves, and all get the results. Memory: 24 bytes for each measure, method and trajectory on each
/// rank, 16 for each measure and trajectory, and none that grows with the steps. Messages: once at the end,
/// these bytes. Throws std::invalid_argument if there is not one measure, step or trajectory, they do not fit
/// into memory, the perturbation is not positive, the horizon is not within the last step, a start does not
/// fit, or what method, reference and measure refuse; std::runtime_error if the reference is not finite. Of
/// several trajectories in trouble it is the first that is named.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Methods Given>
std::vector<trajectory_errors_result> trajectory_errors(
    const S& system, const R& reference, const E& ensemble, const Given& methods,
    std::span<const error_measure<S::dimension, lanes_of<S>>> measures, const trajectory_options& options) {
  constexpr std::size_t most_checks = 16;  // enough for the size of an error
  using M = std::ranges::range_value_t<Given>;
  using T = scalar_of_lanes<lanes_of<S>>;
  const std::size_t count = std::ranges::size(methods);
  const std::span<const M> all(std::ranges::data(methods), count);
  if (measures.empty()) throw std::invalid_argument("trajectory_errors: at least one measure is needed");
  const communicator& ranks = *options.ranks;
  const shard own(options.trajectories, ranks);
  const auto trajectories = static_cast<std::size_t>(options.trajectories);
  const std::size_t checks = std::min(trajectories, most_checks);
  const std::size_t perturbed = options.perturbation ? checks : 0;
  std::vector<detail::measured_trajectories> found;
  sample_weights weights(options.steps);
  int parts = 0;

  const auto follow = [&](std::int64_t first, int n) {
    const auto start = sound_starts<T>(system, ensemble, options.seed, first, n);
    const auto of_block = [&](std::size_t wanted) {
      return static_cast<int>(std::clamp<std::int64_t>(static_cast<std::int64_t>(wanted) - first, 0, n));
    };
    compared_block<M, S, R> block(
        system, reference, all, options.step, measures, start, n,
        {of_block(checks), of_block(perturbed), options.perturbation, options.null_model},
        {parts, options.seed, first}, weights);
    block.run(options.steps);
    block.reference().require_sound(first);
    for (std::size_t i = 0; i < measures.size(); ++i) {
      for (int k = 0; k < n; ++k) {
        const auto slot = static_cast<std::size_t>(first + k);
        auto& its = found[i];
        for (std::size_t method = 0; method < count; ++method) {
          its.runs[method][slot] = block.score(i, method, k);
        }
        if (slot < checks) its.checks[slot] = block.reference().finer_error(i, k);
        if (slot < perturbed) its.predictable_until[slot] = block.reference().predictable_until(i, k);
        if (options.null_model) its.null_model[slot] = block.reference().null_error(i, k);
        its.sizes[slot] = block.reference().size(i, k);
        its.signs[slot] = block.reference().sign(i, k);
      }
    }
  };
  const auto follow_own = [&](std::int64_t block, int n) { follow(own.first() + block, n); };
  together(ranks, [&] {
    require_room(options, count, joined_measures(measures).width(), measures.size());
    parts = parts_of_noise(system, all);
    detail::require_comparable(system, reference, all, parts, options);
    if (options.horizon) weights = sample_weights(options.step, options.steps, *options.horizon);
    found.assign(measures.size(), {count, trajectories, checks, options.null_model, perturbed});
    for_each_block(own.count(), lanes_of<S>, options.threads, follow_own,
                   progress_of_share(ranks, own.count(), options.trajectories, options.progress));
  });
  for (auto& its : found) its.gather(own);

  std::vector<trajectory_errors_result> results;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    results.push_back(detail::summary(found[i], measures[i], reference));
    auto& its_own = results.back().reference_error;
    if (parts > 0 && its_own) its_own->mean *= error_over_difference;
  }
  const auto first = ensemble(options.seed, 0);
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  for (std::size_t method = 0; method < count; ++method) {
    const auto evaluations = evaluations_of_run(system, all[method], options.step, options.steps, first);
    for (auto& its : results)
      its.methods[method].evaluations_per_time = static_cast<double>(evaluations) / time;
  }
  return results;
}

/// The same by one measure.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Methods Given>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const Given& methods,
                                           const error_measure<S::dimension, lanes_of<S>>& measure,
                                           const trajectory_options& options) {
  return std::move(
      trajectory_errors(system, reference, ensemble, methods, std::span(&measure, 1), options).front());
}

/// The same of one method, by one measure or several.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Method M>
auto trajectory_errors(const S& system, const R& reference, const E& ensemble, const M& method,
                       const auto& measures, const trajectory_options& options) {
  return trajectory_errors(system, reference, ensemble, std::span<const M>(&method, 1), measures, options);
}

}  // namespace nysalt
