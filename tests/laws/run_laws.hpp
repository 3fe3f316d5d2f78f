// SPDX-License-Identifier: BSL-1.0
// What holds for runs of every method: what they cost, and that looking or pausing changes nothing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/counted.hpp"

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
/// Jacobian of the flow so far, as the inverse of a symplectic matrix is as large as the matrix; and where
/// friction has shrunk it, by as much more.
template <SeparableSystem S, Method M, NoiseSource Noise = no_noise>
double merging_broken(const S& system, const M& method, double step,
                      const phase_point<double, S::dimension>& x, std::int64_t steps,
                      const Noise& noise = {}) {
  const auto fixed = make_stepper(system, method, step, noise);
  const double letters = roundings(method, size(system));
  auto run = fixed.open(x);
  auto y = x;
  Eigen::MatrixXd flow = Eigen::MatrixXd::Identity(2 * x.size(), 2 * x.size());
  double magnified = 1.0;
  double worst = 0.0;
  for (std::int64_t n = 1; n <= steps; ++n) {
    flow = jacobian([&](auto& z) { fixed.step(z, 0, n - 1); }, y) * flow;
    magnified = std::max(magnified, norm(flow));
    fixed.step(y, 0, n - 1);
    fixed.advance(run, 1);
    double shrunk = 1.0;
    if constexpr (HasBath<S>) shrunk = system.bath().decay(static_cast<double>(n) * step);
    const double rounding =
        4.0 * static_cast<double>(n) * letters * eps * size_of(y) * magnified * magnified / shrunk;
    worst = std::max(worst, distance(fixed.synchronous(run), y) / rounding);
  }
  return worst;
}

/// The finish of a run, as one go.
template <int N>
phase_point<double, N> run_finish(const auto& fixed, const phase_point<double, N>& x, std::int64_t steps,
                                  std::uint64_t trajectory = 0) {
  auto run = fixed.open(x, trajectory);
  fixed.advance(run, steps);
  return fixed.synchronous(run);
}

/// The same, by an advance that shows states on the way: each must be the synchronous state there.
template <int N>
phase_point<double, N> watched_finish(const auto& fixed, const phase_point<double, N>& x, std::int64_t steps,
                                      std::int64_t every) {
  auto run = fixed.open(x);
  auto other = run;
  bool same = true;
  fixed.advance(run, steps, every, [&](std::int64_t n, const auto& seen) {
    fixed.advance(other, n - other.step);
    same = same && same_bits(seen, fixed.synchronous(other));
  });
  if (!same) throw std::logic_error("what is seen is not the synchronous state");
  return fixed.synchronous(run);
}

/// Whether W trajectories side by side have the bits of each alone, run by the same stepper; the first of
/// them has that number, and the noise that goes with it.
template <int W, class Stepper>
bool lanes_are_alone(const Stepper& fixed, draws& random, const auto& reach, std::int64_t steps = 31,
                     std::uint64_t first = 40) {
  constexpr int N = Stepper::dimension;
  std::vector<phase_point<double, N>> alone;
  for (int k = 0; k < W; ++k) alone.push_back(random.state(fixed.system(), reach));
  const auto start = gather<pack<double, W>, N>(W, [&](int k) { return alone[static_cast<std::size_t>(k)]; });
  auto run = fixed.open(start, 40);
  fixed.advance(run, 30);
  fixed.advance(run, 1);
  const auto after = fixed.synchronous(run);
  for (int k = 0; k < W; ++k) {
    auto single = fixed.open(alone[static_cast<std::size_t>(k)], first + static_cast<std::uint64_t>(k));
    fixed.advance(single, steps);
    if (!same_bits(lane(after, k), fixed.synchronous(single))) return false;
  }
  return true;
}

}  // namespace nysalt::test
