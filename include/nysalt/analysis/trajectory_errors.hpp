// SPDX-License-Identifier: BSL-1.0
// Methods at one step against one reference, along many trajectories.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/analysis/compared_block.hpp"
#include "nysalt/analysis/evaluations.hpp"
#include "nysalt/analysis/method_error.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensemble_loop.hpp"
#include "nysalt/langevin.hpp"

namespace nysalt {

struct trajectory_options {
  double step;                      // samples are at t_i = i step, i = 1..steps
  std::int64_t steps;               // of each trajectory
  std::int64_t trajectories = 400;  // independent starts
  std::uint64_t seed = 1;
  int threads = 1;
  std::function<void(std::int64_t done)> progress = {};  // after some trajectories; never two calls at once
};

struct trajectory_errors_result {
  std::vector<method_error> methods;        // in the order in which they were given
  std::optional<estimate> reference_error;  // against its finer self; nothing if no reference was needed
  std::string reference;                    // its description, or empty
};

/// A vector, array or span of methods of one type.
template <class C>
concept Methods =
    std::ranges::contiguous_range<C> && std::ranges::sized_range<C> && Method<std::ranges::range_value_t<C>>;

/// Throws std::invalid_argument unless there are steps and trajectories, and a score of each method and
/// trajectory, and a stretch of samples of `width` numbers for each method and thread, fit into memory.
inline void require_room(const trajectory_options& options, std::size_t methods, std::size_t width) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories of {} steps: at least one of each is needed",
                    options.trajectories, options.steps));
  }
  const double stretches = static_cast<double>(methods + 2) * options.threads * default_lanes;
  const double numbers = stretches * static_cast<double>(steps_between_checks) * static_cast<double>(width);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(methods);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories with {} numbers a sample, on {} threads, do not fit "
                    "into memory; take fewer",
                    options.trajectories, width, options.threads));
  }
}

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

/// Runs the reference once along each trajectory, and every method beside it, as many trajectories at a time
/// as there are lanes. In a bath all see the reference's noise, each in the parts of a step that its letters
/// O cover. The reference's own error is taken on the first 16 trajectories. Neither lanes nor threads change
/// a bit.
///
/// System, reference, ensemble and measure are used by several threads at once. Memory: 24 bytes for each
/// method and trajectory, and none that grows with the steps.
/// Throws std::invalid_argument if there is not one step or trajectory, they do not fit into memory, a start
/// does not fit, or what method, reference and measure refuse; std::runtime_error if the reference is not
/// finite. Of several trajectories in trouble it is the first that is named.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Methods Given>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const Given& methods,
                                           const error_measure<S::dimension, lanes_of<S>>& measure,
                                           const trajectory_options& options) {
  constexpr std::int64_t most_checks = 16;  // enough for the size of an error
  using M = std::ranges::range_value_t<Given>;
  using T = scalar_of_lanes<lanes_of<S>>;
  const std::size_t count = std::ranges::size(methods);
  const std::span<const M> all(std::ranges::data(methods), count);
  require_room(options, count, measure.width);
  const int parts = parts_of_noise(system, all);
  if (parts > 0 && !PathReference<R, S>) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: the reference ({}) has no noise to share; take fine_paths",
                    reference.description()));
  }
  for (const M& method : all) make_stepper(system, method, options.step, counter_noise(0));  // refuses early

  const auto trajectories = static_cast<std::size_t>(options.trajectories);
  std::vector<std::vector<run_score>> runs(count, std::vector<run_score>(trajectories));
  std::vector<double> checks;
  if (measure.needs_reference) checks.resize(std::min<std::size_t>(trajectories, most_checks));

  const auto follow = [&](std::int64_t first, int n) {
    const auto start = sound_starts<T>(system, ensemble, options.seed, first, n);
    const auto to_check = std::clamp<std::int64_t>(std::ssize(checks) - first, 0, n);
    compared_block<M, S, R> block(system, reference, all, options.step, measure, start, n,
                                  static_cast<int>(to_check), {parts, options.seed, first});
    block.run(options.steps);
    block.require_sound(first);
    for (int k = 0; k < n; ++k) {
      const auto slot = static_cast<std::size_t>(first + k);
      if (slot < checks.size()) checks[slot] = block.check(k);
      for (std::size_t method = 0; method < count; ++method) runs[method][slot] = block.score(method, k);
    }
  };
  for_each_block(options.trajectories, lanes_of<S>, options.threads, follow, options.progress);

  trajectory_errors_result result;
  const auto first = ensemble(options.seed, 0);
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  for (const auto& method : methods) {
    const auto& its_runs = runs[result.methods.size()];
    result.methods.push_back(error_of_runs(its_runs, measure));
    const auto evaluations = evaluations_of_run(system, method, options.step, options.steps, first);
    result.methods.back().evaluations_per_time = static_cast<double>(evaluations) / time;
  }
  if (measure.needs_reference) {
    result.reference_error = measure.average(checks);
    result.reference = reference.description();
  }
  return result;
}

/// The same for one method.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Method M>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const M& method,
                                           const error_measure<S::dimension, lanes_of<S>>& measure,
                                           const trajectory_options& options) {
  return trajectory_errors(system, reference, ensemble, std::span<const M>(&method, 1), measure, options);
}

}  // namespace nysalt
