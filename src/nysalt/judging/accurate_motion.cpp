// SPDX-License-Identifier: BSL-1.0
#include "accurate_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::detail {

double median_of(std::vector<double>& numbers) {
  if (numbers.empty()) return 0.0;
  const auto middle = numbers.begin() + std::ssize(numbers) / 2;
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

double parts_of_step(const model& system, double step) {
  double highest = 0.0;
  if (has_frequency_bands(system)) {
    for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  } else if (has_modes(system)) {
    highest = detail::frequency_to_fit(system);
  }
  return std::max(8.0, std::ceil(std::abs(step) * highest));
}

namespace {

template <class T>
accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options) {
  constexpr std::int64_t most_trajectories = 64;
  constexpr std::int64_t most_steps = 400;
  constexpr std::int64_t samples = 8;  // states of each trajectory
  constexpr double share = 0.125;      // of the work of a trial
  accurate_motion result;
  const double parts = parts_of_step(system, step);
  const auto fine = static_cast<std::int64_t>(std::min(parts, most_parts));
  const tabulated accurate(blanes_moan_s6{});
  const auto cost = static_cast<double>(fine * accurate.letters().evaluations_per_step);
  const std::int64_t trajectories = std::min<std::int64_t>(most_trajectories, std::ssize(starts));
  const auto steps =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(share * static_cast<double>(evaluations) /
                                                         (cost * static_cast<double>(trajectories))),
                               samples, most_steps);
  const std::int64_t every = steps / samples * fine;
  const bool knows_kinetic = has_energy(system);
  std::vector<std::vector<double>> kinetic(static_cast<std::size_t>(trajectories));
  std::vector<states> seen(static_cast<std::size_t>(trajectories));
  const auto n = static_cast<std::size_t>(size(system));
  const auto read = [&](const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) {
    for (std::size_t i = 0; i < n; ++i) {
      numbers[i] = x.q[static_cast<Eigen::Index>(i)];
      numbers[n + i] = x.p[static_cast<Eigen::Index>(i)];
    }
    if (!knows_kinetic) return;
    auto at_rest = x;
    for (T& p : at_rest.p) p = T(0.0);
    numbers[2 * n] = energy<T>(system, x) - energy<T>(system, at_rest);
  };
  const auto take = [&](std::int64_t m, std::int64_t at, std::span<const double> numbers) {
    const auto of = static_cast<std::size_t>(m);
    if (knows_kinetic && std::isfinite(numbers[2 * n])) kinetic[of].push_back(numbers[2 * n]);
    phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd(size(system)), Eigen::VectorXd(size(system))};
    std::copy_n(numbers.begin(), n, x.q.begin());
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(n), n, x.p.begin());
    if (at % every == 0 && is_finite(x)) seen[of].push_back(x);
  };
  const auto stepper =
      make_stepper(system, accurate, step / static_cast<double>(fine), counter_noise(options.seed));
  integrate_ensemble<T>(stepper, listed<Eigen::Dynamic>(starts),
                        {.trajectories = trajectories,
                         .steps = steps / samples * samples * fine,
                         .every = fine,
                         .seed = options.seed,
                         .threads = options.threads},
                        2 * n + 1, read, take);
  std::vector<double> all;
  for (const auto& some : kinetic) all.insert(all.end(), some.begin(), some.end());
  result.kinetic_energy = median_of(all);
  if (!std::isfinite(result.kinetic_energy) || result.kinetic_energy < 0.0) result.kinetic_energy = 0.0;
  for (auto& some : seen) result.seen.insert(result.seen.end(), some.begin(), some.end());
  return result;
}

}  // namespace

accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options) {
  return with_scalar_of(
      system, [&]<class T>(T) { return follow<T>(system.base(), starts, step, evaluations, options); });
}

}  // namespace nysalt::detail
