// SPDX-License-Identifier: BSL-1.0
// How far an observable strays from its reference along trajectories.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/counted.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Values of an observable at t_i = i step, i = 1.., one path a trajectory.
struct observable_paths {
  double step;
  std::vector<std::vector<double>> values;
};

/// The paths along a reference, `steps` steps from each start.
template <SeparableSystem S, ReferenceFlow<S> R>
observable_paths reference_paths(const S& system, const R& reference, double step, std::int64_t steps,
                                 const std::vector<phase_point<double, S::dimension>>& starts,
                                 const auto& observable) {
  observable_paths paths{step, {}};
  for (auto x : starts) {
    auto& path = paths.values.emplace_back();
    for (std::int64_t i = 0; i < steps; ++i) {
      reference.advance(system, x, step);
      path.push_back(observable(x));
    }
  }
  return paths;
}

/// Root mean square over the path of (a - b)/b [li_lu_tao_ye_2023, equation (5.7)].
/// Throws std::invalid_argument if the paths differ in length or b vanishes somewhere.
inline double relative_rms(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || b.empty() || std::find(b.begin(), b.end(), 0.0) != b.end()) {
    throw std::invalid_argument(
        "a relative error needs two paths of one length, and a reference that is never 0");
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]) / (b[i] * b[i]);
  return std::sqrt(sum / static_cast<double>(b.size()));
}

struct path_error_result {
  estimate error;                         // over the trajectories that did not diverge
  std::int64_t diverged = 0;              // trajectories
  std::vector<std::int64_t> diverged_at;  // their steps
  double evaluations_per_time = 0.0;      // force evaluations of one whole trajectory, start-up included
};

/// The paper's average relative error of an observable [li_lu_tao_ye_2023, equation (5.6)], with its
/// standard error over trajectories. Evaluations are counted on the first trajectory, run to its end.
/// Throws std::invalid_argument unless the reference has a path, sampled at this step, for each start.
template <SeparableSystem S, Method M>
path_error_result path_error(const S& system, const M& method, double step,
                             const std::vector<phase_point<double, S::dimension>>& starts,
                             const observable_paths& reference, const auto& observable) {
  if (starts.empty() || reference.values.size() != starts.size() ||
      !(std::abs(reference.step - step) <= 1e-9 * std::abs(step))) {
    throw std::invalid_argument(
        fmt::format("path_error: {} starts at step {} against {} reference paths at step {}", starts.size(),
                    step, reference.values.size(), reference.step));
  }
  path_error_result result;
  std::vector<double> errors;
  std::vector<double> path;
  const auto watch = [&](std::int64_t n, double, const auto& x) {
    if (n > 0) path.push_back(observable(x));
  };
  const auto stepper = make_stepper(system, method, step);
  for (std::size_t m = 0; m < starts.size(); ++m) {
    path.clear();
    const auto& expected = reference.values[m];
    const auto end = integrate(stepper, starts[m], static_cast<std::int64_t>(expected.size()), watch, 1);
    if (end.diverged_at) {
      ++result.diverged;
      result.diverged_at.push_back(*end.diverged_at);
    } else {
      errors.push_back(relative_rms(path, expected));
    }
  }
  result.error = mean_and_error(errors);
  const counted<S> watched(system);
  const auto counting = make_stepper(watched, method, step);
  auto run = counting.open(starts.front());
  counting.advance(run, static_cast<std::int64_t>(reference.values.front().size()));
  result.evaluations_per_time =
      static_cast<double>(watched.evaluations) / (static_cast<double>(run.step) * std::abs(step));
  return result;
}

}  // namespace nysalt
