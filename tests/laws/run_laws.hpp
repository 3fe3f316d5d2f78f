// SPDX-License-Identifier: BSL-1.0
// What holds for runs of every method: what they cost, and that looking or pausing changes nothing.
#pragma once

#include <algorithm>
#include <cstdint>

#include "../support/rounding.hpp"
#include "nysalt/counted.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/integrate.hpp"

namespace nysalt::test {

/// Force evaluations that a run of n steps takes, its opening and a look at every state included.
template <SeparableSystem S, Method M>
std::int64_t evaluations_of_run(const S& system, const M& method, double step,
                                const phase_point<double, S::dimension>& x, std::int64_t steps) {
  const counted<S> watched(system);
  const auto all = make_stepper(watched, method, step);
  auto run = all.open(x);
  for (std::int64_t n = 0; n < steps; ++n) {
    all.advance(run, 1);
    all.synchronous(run);
  }
  return watched.evaluations;
}

template <SeparableSystem S, Method M>
std::int64_t evaluations_of_step(const S& system, const M& method, double step,
                                 phase_point<double, S::dimension> x) {
  const counted<S> watched(system);
  make_stepper(watched, method, step).step(x);
  return watched.evaluations;
}

/// How far the merged run is from repeated plain steps, in units of what rounding may do. Each letter of
/// each step rounds every coordinate twice, in both; the flow magnifies it by at most |J|^2 with J the
/// Jacobian of the flow so far, as the inverse of a symplectic matrix is as large as the matrix.
template <SeparableSystem S, Method M>
double merging_broken(const S& system, const M& method, double step,
                      const phase_point<double, S::dimension>& x, std::int64_t steps) {
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  auto y = x;
  Eigen::MatrixXd flow = Eigen::MatrixXd::Identity(2 * x.size(), 2 * x.size());
  double magnified = 1.0;
  double worst = 0.0;
  for (std::int64_t n = 1; n <= steps; ++n) {
    flow = jacobian(step_map(system, method, step), y) * flow;
    magnified = std::max(magnified, norm(flow));
    fixed.step(y);
    fixed.advance(run, 1);
    const double rounding = 4.0 * static_cast<double>(n) * static_cast<double>(M::word::length) * eps *
                            size_of(y) * magnified * magnified;
    worst = std::max(worst, distance(fixed.synchronous(run), y) / rounding);
  }
  return worst;
}

/// The finish of a run that is looked at every so often, by integrate.
template <SeparableSystem S, Method M>
phase_point<double, S::dimension> observed_finish(const S& system, const M& method, double step,
                                                  const phase_point<double, S::dimension>& x,
                                                  std::int64_t steps, std::int64_t every) {
  const auto look = [](std::int64_t, double, const auto&) {};
  return integrate(system, method, step, x, steps, look, every).finish;
}

/// The finish of a run that is cut in two, the open run being all that is kept.
template <SeparableSystem S, Method M>
phase_point<double, S::dimension> cut_finish(const S& system, const M& method, double step,
                                             const phase_point<double, S::dimension>& x, std::int64_t steps,
                                             std::int64_t first) {
  auto kept = [&] {
    const auto before = make_stepper(system, method, step);
    auto run = before.open(x);
    before.advance(run, first);
    return run;
  }();
  const auto after = make_stepper(system, method, step);
  after.advance(kept, steps - first);
  return after.synchronous(kept);
}

/// The finish of a run that is closed and opened anew at every step: what looking must not do.
template <SeparableSystem S, Method M>
phase_point<double, S::dimension> reopened_finish(const S& system, const M& method, double step,
                                                  phase_point<double, S::dimension> x, std::int64_t steps) {
  const auto fixed = make_stepper(system, method, step);
  for (std::int64_t n = 0; n < steps; ++n) {
    auto run = fixed.open(x);
    fixed.advance(run, 1);
    x = fixed.synchronous(run);
  }
  return x;
}

}  // namespace nysalt::test
