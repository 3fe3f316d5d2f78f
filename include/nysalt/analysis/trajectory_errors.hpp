// SPDX-License-Identifier: BSL-1.0
// Methods at one step against one reference, along many trajectories.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/analysis/method_error.hpp"
#include "nysalt/counted.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensemble_loop.hpp"

namespace nysalt {

struct trajectory_options {
  double step;                      // samples are at t_i = i step, i = 1..steps
  std::int64_t steps;               // of each trajectory
  std::int64_t trajectories = 400;  // independent starts
  std::uint64_t seed = 1;
  int threads = 1;
  std::function<void(std::int64_t done)> progress = {};  // after each trajectory; never two calls at once
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

/// Throws std::invalid_argument unless there are steps and trajectories, and `width` numbers of each step and
/// a score of each method and trajectory fit into memory.
inline void require_room(const trajectory_options& options, std::size_t methods, std::size_t width) {
  if (options.steps < 1 || options.trajectories < 1) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories of {} steps: at least one of each is needed",
                    options.trajectories, options.steps));
  }
  // Two paths on each thread while the reference is checked.
  const double numbers =
      2.0 * options.threads * static_cast<double>(options.steps) * static_cast<double>(width);
  const double scores = static_cast<double>(options.trajectories) * static_cast<double>(methods);
  if (numbers > 1e9 || scores > 1e8) {
    throw std::invalid_argument(
        fmt::format("trajectory_errors: {} trajectories of {} steps do not fit into memory; take fewer or a "
                    "shorter horizon",
                    options.trajectories, options.steps));
  }
}

namespace detail {

/// The start of trajectory m. Throws std::invalid_argument if it is not finite or does not fit.
template <System S, Ensemble<S> E>
phase_point<double, S::dimension> sound_start(const S& system, const E& ensemble, std::uint64_t seed,
                                              std::int64_t m) {
  auto start = ensemble(seed, static_cast<std::uint64_t>(m));
  if (start.q.size() == size(system) && start.p.size() == size(system) && is_finite(start)) return start;
  throw std::invalid_argument(
      fmt::format("trajectory_errors: start {} of {} is not finite or has not the dimension of {}", m,
                  ensemble.description(), describe(system)));
}

/// Force evaluations per unit time along one trajectory, to its end whether it diverges or not.
template <SeparableSystem S, Method M>
double evaluations_per_time(const S& system, const M& method, const phase_point<double, S::dimension>& start,
                            const trajectory_options& options) {
  const counted<S> watched(system);
  const auto stepper = make_stepper(watched, method, options.step);
  auto run = stepper.open(start);
  stepper.advance(run, options.steps);
  const double time = static_cast<double>(options.steps) * std::abs(options.step);
  return static_cast<double>(watched.evaluations) / time;
}

}  // namespace detail

/// Runs the reference once along each trajectory, keeps the numbers that the measure reads, and follows
/// every method beside it. The reference's own error is taken on the first 16 trajectories. The number of
/// threads changes no bit.
///
/// System, reference, ensemble and measure are used by several threads at once. Memory: per thread
/// steps * width numbers (twice that for the first 16), and 24 bytes for each method and trajectory.
/// Throws std::invalid_argument if there is not one step or trajectory, they do not fit into memory, a start
/// does not fit, or what method, reference and measure refuse; std::runtime_error if the reference is not
/// finite. Of several trajectories in trouble it is the first that is named.
template <SeparableSystem S, ReferenceFlow<S> R, Ensemble<S> E, Methods Given>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const Given& methods, const error_measure<S::dimension>& measure,
                                           const trajectory_options& options) {
  constexpr std::int64_t most_checks = 16;  // enough for the size of an error
  const std::size_t count = std::ranges::size(methods);
  require_room(options, count, measure.needs_reference ? measure.width : 0);
  std::vector<decltype(make_stepper(system, *std::ranges::data(methods), options.step))> steppers;
  for (const auto& method : methods) steppers.push_back(make_stepper(system, method, options.step));

  const auto trajectories = static_cast<std::size_t>(options.trajectories);
  std::vector<std::vector<run_score>> runs(count, std::vector<run_score>(trajectories));
  std::vector<double> checks;
  if (measure.needs_reference) checks.resize(std::min<std::size_t>(trajectories, most_checks));

  const auto follow = [&](std::int64_t m) {
    const auto slot = static_cast<std::size_t>(m);
    const auto start = detail::sound_start(system, ensemble, options.seed, m);
    const auto at_start = measure.numbers_of(start);
    const auto along = [&](const R& its) {
      return reference_numbers(system, its, options.step, options.steps, start, measure, m);
    };
    std::vector<double> expected;
    if (measure.needs_reference) expected = along(reference);
    if (slot < checks.size()) {
      const auto finer = along(reference.finer());
      checks[slot] = score_of_path<S::dimension>(expected, measure, error_sum(measure, finer, at_start));
    }
    for (std::size_t k = 0; k < count; ++k) {
      const error_sum errors(measure, expected, at_start);
      runs[k][slot] = score_of_run(steppers[k], start, options.steps, measure, errors);
    }
  };
  for_each_trajectory(options.trajectories, options.threads, follow, options.progress);

  trajectory_errors_result result;
  const auto first = ensemble(options.seed, 0);
  for (const auto& method : methods) {
    const auto& its_runs = runs[result.methods.size()];
    result.methods.push_back(error_of_runs(its_runs, measure));
    result.methods.back().evaluations_per_time = detail::evaluations_per_time(system, method, first, options);
  }
  if (measure.needs_reference) {
    result.reference_error = measure.average(checks);
    result.reference = reference.description();
  }
  return result;
}

/// The same for one method.
template <SeparableSystem S, ReferenceFlow<S> R, Ensemble<S> E, Method M>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const M& method, const error_measure<S::dimension>& measure,
                                           const trajectory_options& options) {
  return trajectory_errors(system, reference, ensemble, std::span<const M>(&method, 1), measure, options);
}

}  // namespace nysalt
