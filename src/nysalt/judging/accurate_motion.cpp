// SPDX-License-Identifier: BSL-1.0
#include "accurate_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::detail {

double median_of(std::vector<double>& numbers) {
  if (numbers.empty()) return 0.0;
  const auto middle = numbers.begin() + std::ssize(numbers) / 2;
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

namespace {

/// What one trajectory shows, up to where its energy errs by more than 1 % of its largest kinetic energy,
/// as after a close encounter that is too close for the step: what comes then is not the motion.
struct shown_motion {
  std::vector<double> kinetic;
  states seen;
  double initial = 0.0;
  double largest_kinetic = 0.0;
  bool has_left = false;

  bool holds(double energy, double kinetic_energy) {
    constexpr double hundredth = 0.01;
    largest_kinetic = std::max(largest_kinetic, kinetic_energy);
    if (!(std::abs(energy - initial) <= hundredth * largest_kinetic)) has_left = true;
    return !has_left;
  }
  /// From rest, or from a turning point, kinetic energies rise first.
  bool rises() const { return !kinetic.empty() && kinetic.back() == largest_kinetic; }
};

constexpr std::int64_t most_steps = 400;

template <class T>
accurate_motion follow_at(double step, const model& system, const states& starts, std::int64_t evaluations,
                          const judging_options& options) {
  constexpr std::int64_t most_trajectories = 64;
  constexpr std::int64_t fewest = 4;
  constexpr std::int64_t coordinates = 1'000'000;  // of all trajectories: a large system needs few
  constexpr std::int64_t samples = 8;              // states of each trajectory
  constexpr double share = 0.03;                   // of the work of a trial
  const tabulated accurate(blanes_moan_s6{});
  const double affordable = share * static_cast<double>(evaluations);
  const int of_step = accurate.letters().evaluations_per_step;
  std::int64_t trajectories =
      std::min(static_cast<std::int64_t>(affordable / static_cast<double>(of_step * samples)),
               coordinates / size(system));
  trajectories =
      std::min<std::int64_t>(std::clamp(trajectories, fewest, most_trajectories), std::ssize(starts));
  const double cost = static_cast<double>(of_step * trajectories);
  const auto steps =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(affordable / cost), samples, most_steps);
  const std::int64_t every = steps / samples;
  const bool knows_kinetic = has_energy(system);
  constexpr Eigen::Index few = 1000;
  const bool keeps_states = size(system) <= few;  // a larger system has all its frequencies in each start
  std::vector<shown_motion> shown(static_cast<std::size_t>(trajectories));
  const auto n = static_cast<std::size_t>(keeps_states ? size(system) : 0);
  const auto read = [&](const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) {
    for (std::size_t i = 0; i < n; ++i) {
      numbers[i] = x.q[static_cast<Eigen::Index>(i)];
      numbers[n + i] = x.p[static_cast<Eigen::Index>(i)];
    }
    if (!knows_kinetic) return;
    auto at_rest = x;
    for (T& p : at_rest.p) p = T(0.0);
    numbers[2 * n + 1] = energy<T>(system, x);
    numbers[2 * n] = numbers[2 * n + 1] - energy<T>(system, at_rest);
  };
  const auto take = [&](std::int64_t m, std::int64_t at, std::span<const double> numbers) {
    shown_motion& one = shown[static_cast<std::size_t>(m)];
    if (knows_kinetic) {
      if (at == 0) one.initial = numbers[2 * n + 1];
      if (!one.holds(numbers[2 * n + 1], numbers[2 * n])) return;
      one.kinetic.push_back(numbers[2 * n]);
    }
    if (!keeps_states || at % every != 0) return;
    phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd(size(system)), Eigen::VectorXd(size(system))};
    std::copy_n(numbers.begin(), n, x.q.begin());
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(n), n, x.p.begin());
    if (is_finite(x)) one.seen.push_back(x);
  };
  const auto stepper = make_stepper(system, accurate, step, counter_noise(options.seed));
  integrate_ensemble<T>(stepper, listed<Eigen::Dynamic>(starts),
                        {.trajectories = trajectories,
                         .steps = every * samples,
                         .every = 1,
                         .seed = options.seed,
                         .threads = options.threads},
                        2 * n + 2, read, take);
  accurate_motion result;
  result.step = step;
  std::vector<double> all;
  for (const shown_motion& one : shown) {
    all.insert(all.end(), one.kinetic.begin(), one.kinetic.end());
    result.seen.insert(result.seen.end(), one.seen.begin(), one.seen.end());
  }
  if (!keeps_states)
    result.seen.assign(starts.begin(), starts.begin() + std::min(samples, std::ssize(starts)));
  const std::int64_t reads = trajectories * (every * samples + 1);
  result.is_followed = !knows_kinetic || 2 * std::ssize(all) >= reads;
  // So short a piece may show no more than how all trajectories begin.
  const bool is_short = every * samples <= 4 * samples;
  if (is_short && 2 * std::ranges::count_if(shown, &shown_motion::rises) >= trajectories) return result;
  result.kinetic_energy = std::max(0.0, median_of(all));
  return result;
}

}  // namespace

accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options) {
  constexpr double finer = 0.25;
  return in_lanes_if_filled(system, std::ssize(starts), [&]<class T>(T) {
    const double shortest = finest_step * step;
    // Functions of others may refuse the states that too coarse a step leads to: they are asked near the
    // motion.
    constexpr double fine = 0.125;
    const double coarsest = static_cast<double>(options.steps) / static_cast<double>(most_steps);
    double length = step * (is_black_box(system) ? fine : std::max(1.0, coarsest));
    accurate_motion motion = follow_at<T>(length, system.base(), starts, evaluations, options);
    while (!motion.is_followed && length > shortest) {
      length = std::max(shortest, finer * length);
      motion = follow_at<T>(length, system.base(), starts, evaluations, options);
    }
    return motion;
  });
}

}  // namespace nysalt::detail
