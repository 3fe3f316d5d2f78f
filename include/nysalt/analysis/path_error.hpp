// SPDX-License-Identifier: BSL-1.0
// How far an observable strays from its reference along trajectories.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/counted.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Values of an observable at t_i = i step, i = 1..steps, along the reference from each start.
template <SeparableSystem S, ReferenceFlow<S> R>
std::vector<std::vector<double>> reference_paths(const S& system, const R& reference, double step,
                                                 std::int64_t steps,
                                                 const std::vector<phase_point<double, S::dimension>>& starts,
                                                 const auto& observable) {
  std::vector<std::vector<double>> paths;
  for (auto x : starts) {
    auto& path = paths.emplace_back();
    for (std::int64_t i = 0; i < steps; ++i) {
      reference.advance(system, x, step);
      path.push_back(observable(x));
    }
  }
  return paths;
}

/// Root mean square over the path of (a - b)/b; b must not vanish [li_lu_tao_ye_2023, equation (5.7)].
inline double relative_rms(const std::vector<double>& a, const std::vector<double>& b) {
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
/// standard error over trajectories. Evaluations are counted while the first trajectory runs.
template <SeparableSystem S, Method M>
path_error_result path_error(const S& system, const M& method, double step,
                             const std::vector<phase_point<double, S::dimension>>& starts,
                             const std::vector<std::vector<double>>& reference, const auto& observable) {
  path_error_result result;
  std::vector<double> errors;
  std::vector<double> path;
  const auto watch = [&](std::int64_t n, double, const auto& x) {
    if (n > 0) path.push_back(observable(x));
  };
  const auto stepper = make_stepper(system, method, step);
  for (std::size_t m = 0; m < starts.size(); ++m) {
    path.clear();
    const auto steps = static_cast<std::int64_t>(reference[m].size());
    const auto end = integrate(stepper, starts[m], steps, watch, 1);
    if (end.diverged_at) {
      ++result.diverged;
      result.diverged_at.push_back(*end.diverged_at);
    } else {
      errors.push_back(relative_rms(path, reference[m]));
    }
  }
  result.error = mean_and_error(errors);
  if (!starts.empty()) {
    const counted<S> watched(system);
    const auto steps = static_cast<std::int64_t>(reference.front().size());
    const auto end = integrate(watched, method, step, starts.front(), steps);
    result.evaluations_per_time =
        static_cast<double>(watched.evaluations) / (static_cast<double>(end.steps) * std::abs(step));
  }
  return result;
}

}  // namespace nysalt
