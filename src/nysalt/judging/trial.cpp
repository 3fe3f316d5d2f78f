// SPDX-License-Identifier: BSL-1.0

#include "trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>

#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
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
  const method accurate(blanes_moan_s6{});
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
                         .execution = {.threads = options.execution.threads}},
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

trial_plan plan_of(std::int64_t evaluations, int of_step, std::int64_t starts, std::int64_t most_steps) {
  constexpr std::int64_t enough = 512;
  constexpr std::int64_t fewest = 8;
  constexpr std::int64_t long_enough = 5'000;
  constexpr std::int64_t shortest = 500;
  const std::int64_t steps_in_all = evaluations / std::max(1, of_step);
  const std::int64_t least = std::clamp<std::int64_t>(steps_in_all / shortest, 1, fewest);
  trial_plan plan;
  plan.trajectories = std::clamp(steps_in_all / std::min(long_enough, most_steps), least, enough);
  plan.trajectories = std::min(plan.trajectories, starts);
  plan.steps = std::min(most_steps, std::max(shortest, steps_in_all / plan.trajectories));
  return plan;
}

namespace {

/// Which of some trajectories an accurate method loses too: at a fine step and, so that it is not its own
/// instability, at a finer one.
template <class T>
std::vector<bool> are_unconfined(const trial_setting& setting, const states& at, std::int64_t parts) {
  std::vector<bool> result(at.size(), true);
  if (at.empty()) return result;
  for (const std::int64_t finer : {parts, 4 * parts}) {
    const auto accurate =
        make_stepper(setting.system, method(blanes_moan_s6{}), setting.step / static_cast<double>(finer),
                     counter_noise(setting.options.seed));
    const auto diverged_at = integrate_ensemble<T>(
        accurate, listed<Eigen::Dynamic>(at),
        {.trajectories = std::ssize(at),
         .steps = finer * setting.plan.steps,
         .every = finer * setting.plan.steps,
         .execution = {.threads = setting.options.execution.threads}},
        1, [](const auto&, std::span<T>) {}, [](auto&&...) {});
    for (std::size_t k = 0; k < at.size(); ++k) result[k] = result[k] && diverged_at[k].has_value();
    if (std::ranges::none_of(result, std::identity{})) break;
  }
  return result;
}

/// Leaves out those of some diverged trajectories that an accurate method loses, too. A few at a time: the
/// first that the motion does not lose decides.
template <class T>
void leave_out_unconfined(const trial_setting& setting, const std::vector<std::size_t>& diverged,
                          unconfined_starts& known, std::vector<course>& courses) {
  constexpr double fewest_parts = 8.0;  // finer than a step at which the energy stays by chance
  constexpr double most_parts = 64.0;   // of more parts nothing is asked: the step is far too long
  const double wanted = std::max(fewest_parts, std::ceil(setting.step / setting.motion.step));
  if (wanted >= most_parts || setting.system.bath().acts()) return;
  const std::int64_t steps = setting.plan.steps;
  const auto parts = static_cast<std::int64_t>(wanted);
  constexpr std::size_t few = 8;
  for (std::size_t begin = 0; begin < diverged.size(); begin += few) {
    const std::size_t end = std::min(begin + few, diverged.size());
    states some;
    std::vector<std::size_t> unknown;
    for (std::size_t k = begin; k < end; ++k) {
      if (known.contains({diverged[k], steps})) continue;
      unknown.push_back(diverged[k]);
      some.push_back(setting.starts[diverged[k]]);
    }
    const auto unconfined = are_unconfined<T>(setting, some, parts);
    for (std::size_t k = 0; k < unknown.size(); ++k) known[{unknown[k], steps}] = unconfined[k];
    bool are_all = true;
    for (std::size_t k = begin; k < end; ++k) {
      courses[diverged[k]].is_left_out = known.at({diverged[k], steps});
      are_all = are_all && courses[diverged[k]].is_left_out;
    }
    if (!are_all) return;
  }
}

/// Whether some trajectories leave nothing to ask: energies err by less than half of what is large, and by no
/// more in the second half of the trial than growth in proportion to time makes of the first.
bool are_clear(const std::vector<course>& courses, double kinetic_energy) {
  if (!(kinetic_energy > 0.0)) return false;
  double first_half = 0.0;
  double second_half = 0.0;
  for (const course& one : courses) {
    if (one.diverged_at) return false;
    for (std::size_t w = 0; w < one.largest.size(); ++w) {
      double& half = 2 * w < one.largest.size() ? first_half : second_half;
      half = std::max(half, one.largest[w]);
    }
  }
  return std::max(first_half, second_half) < 0.5 * large_error * kinetic_energy &&
         second_half < 2.0 * first_half;
}

template <class T>
std::vector<course> run_trial(const trial_setting& setting, const method& method,
                              unconfined_starts& unconfined) {
  constexpr std::int64_t block = 64;
  constexpr std::int64_t every = 7;  // no low-order resonance has this period
  const double kinetic_energy = setting.motion.kinetic_energy;
  const bool watches = setting.watches;
  const trial_plan& plan = setting.plan;
  const listed<Eigen::Dynamic> all(setting.starts);
  const auto stepper =
      make_stepper(setting.system, method, setting.step, counter_noise(setting.options.seed));
  std::vector<course> courses;
  const auto read = [&](const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) {
    if (watches) numbers[0] = energy<T>(setting.system, x);
  };
  const auto take = [&](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
    if (!watches) return;
    course& one = courses[static_cast<std::size_t>(m)];
    if (n == 0) one.initial = numbers[0];
    double departure = std::abs(numbers[0] - one.initial);
    if (std::isnan(departure)) departure = std::numeric_limits<double>::infinity();
    const auto window = static_cast<std::size_t>(std::min(windows - 1, n * windows / plan.steps));
    one.sum[window] += departure;
    one.reads[window] += 1.0;
    one.largest[window] = std::max(one.largest[window], departure);
    one.magnitude = std::max(one.magnitude, std::abs(numbers[0]));
    if (window + 1 == static_cast<std::size_t>(windows)) one.last.push_back(departure);
    if (departure > kinetic_energy && one.large_at < 0) one.large_at = n;
    if (departure <= one.largest_of_all) return;
    one.largest_of_all = departure;
    one.at = n;
  };
  std::int64_t lost = 0;
  for (std::int64_t first = 0; first < plan.trajectories && lost * 2 <= first; first += block) {
    const std::int64_t count = std::min(block, plan.trajectories - first);
    courses.resize(static_cast<std::size_t>(first + count));
    const auto diverged_at =
        integrate_ensemble<T>(stepper, all,
                              {.trajectories = count,
                               .steps = plan.steps,
                               .every = watches ? every : plan.steps,
                               .seed = setting.options.seed,
                               .execution = {.threads = setting.options.execution.threads},
                               .first = first},
                              1, read, take);
    std::vector<std::size_t> diverged;
    for (std::size_t k = 0; k < diverged_at.size(); ++k) {
      const std::size_t m = static_cast<std::size_t>(first) + k;
      courses[m].diverged_at = diverged_at[k];
      if (diverged_at[k]) diverged.push_back(m);
    }
    leave_out_unconfined<T>(setting, diverged, unconfined, courses);
    for (std::int64_t m = first; m < first + count; ++m) {
      const course& one = courses[static_cast<std::size_t>(m)];
      if (one.diverged_at && !one.is_left_out) ++lost;
    }
    if (first == block && are_clear(courses, kinetic_energy)) break;
  }
  return courses;
}

}  // namespace

std::vector<course> run_trial(const trial_setting& setting, const method& method,
                              unconfined_starts& unconfined) {
  return in_lanes_if_filled(setting.system, setting.plan.trajectories,
                            [&]<class T>(T) { return run_trial<T>(setting, method, unconfined); });
}

}  // namespace nysalt::detail
