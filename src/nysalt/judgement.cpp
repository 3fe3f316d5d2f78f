// SPDX-License-Identifier: BSL-1.0
#include "nysalt/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "judging/trial.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/stability_guard.hpp"

namespace nysalt {

namespace {

using detail::accurate_motion;
using detail::course;
using detail::median_of;
using detail::states;
using detail::windows;

/// A good method loses at most this share in a run `longer` times as long as the trial; one that loses more
/// in the trial loses trajectories.
constexpr double few_lost = 0.02;
/// Of the trajectories of the trial: what happens to them at random times happens to `longer` times as many
/// in the longer run.
constexpr double few_in_trial = few_lost / detail::longer;
constexpr double most = 0.95;  // quantile of energy errors, and confidence of the bound on the share lost

/// Slope of some numbers, one for each window, over all windows: the median of the slopes between any two
/// [sen_1968].
double slope_of(const std::array<double, windows>& level) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < level.size(); ++i) {
    for (std::size_t k = i + 1; k < level.size(); ++k) {
      slopes.push_back((level[k] - level[i]) / static_cast<double>(k - i));
    }
  }
  return median_of(slopes) * static_cast<double>(windows);
}

/// The number that a share of some numbers is below; puts them into another order.
double quantile_of(std::vector<double>& numbers, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size()));
  const auto at = numbers.begin() + std::min(rank, std::ssize(numbers) - 1);
  std::nth_element(numbers.begin(), at, numbers.end());
  return *at;
}

/// Least growth from one half of the trial to the other that the finite number of trajectories leaves open:
/// each quantile by one standard error sqrt(N p (1 - p)) of its rank, against the growth. Energies that jump
/// now and then have a quantile that doubles by chance.
double least_growth(std::vector<double>& first_half, std::vector<double>& second_half, double share) {
  const double error = std::sqrt(share * (1.0 - share) / static_cast<double>(first_half.size()));
  const double before = quantile_of(first_half, share + error);
  return before > 0.0 ? quantile_of(second_half, share - error) / before : 0.0;
}

/// Puts what the trajectories did into the judgement. Returns the least growth of the energy error.
double summarise(std::vector<course>& courses, double rounding, judgement& found) {
  const double scale = found.kinetic_energy;
  std::vector<double> errors;
  std::array<std::vector<double>, windows> levels;
  std::vector<double> first_half;
  std::vector<double> second_half;
  double least = 0.0;  // what rounding makes of an energy
  for (std::size_t m = 0; m < courses.size(); ++m) {
    course& one = courses[m];
    if (one.is_left_out) {
      ++found.unconfined;
      continue;
    }
    ++found.trajectories;
    bool is_lost = one.diverged_at.has_value();
    bool exceeds = is_lost;
    if (is_lost) ++found.diverged;
    if (found.energy_was_watched && !is_lost) {
      const double too_much = scale + rounding * one.magnitude;
      is_lost = median_of(one.last) > too_much;
      exceeds = one.largest_of_all > too_much;
      errors.push_back(one.largest_of_all / scale);
      if (errors.back() > found.energy_error.largest) {
        found.energy_error.largest = errors.back();
        found.farthest = {static_cast<std::int64_t>(m), one.at};
      }
      first_half.push_back(0.0);
      second_half.push_back(0.0);
      for (std::size_t w = 0; w < levels.size(); ++w) {
        if (one.reads[w] > 0.0) levels[w].push_back(one.sum[w] / one.reads[w] / scale);
        double& half = (2 * w < levels.size() ? first_half : second_half).back();
        half = std::max(half, one.largest[w] - rounding * one.magnitude);
      }
      least = std::max(least, rounding * one.magnitude);
    }
    if (exceeds) ++found.exceeding;
    if (!is_lost) continue;
    ++found.lost;
    if (!found.first_lost) {
      found.first_lost = {static_cast<std::int64_t>(m),
                          one.diverged_at.value_or(std::max<std::int64_t>(0, one.large_at))};
    }
  }
  if (errors.empty()) return 0.0;
  constexpr double all_but_few = 1.0 - few_lost;
  found.energy_error.median = median_of(errors);
  found.energy_error.most = quantile_of(errors, most);
  found.energy_error.nearly_all = quantile_of(errors, all_but_few);
  const double later = quantile_of(second_half, all_but_few);
  found.growth = later > 0.0 ? later / std::max(quantile_of(first_half, all_but_few), least) : 0.0;
  std::array<double, windows> level{};
  for (std::size_t w = 0; w < levels.size(); ++w) level[w] = median_of(levels[w]);
  found.drift = slope_of(level);
  return least_growth(first_half, second_half, all_but_few);
}

/// The energy error that nearly all trajectories stay below in a run `longer` times as long: a power of time
/// grows by its square for another two doublings, and what is shown to grow faster than time itself is taken
/// to be exponential.
double projected(const judgement& found, double least_growth) {
  constexpr double linear = 2.0;  // growth of what is proportional to time
  const double growth = std::max(1.0, found.growth);
  const double further_halves = 2.0 * detail::longer - 2.0;
  return found.energy_error.nearly_all *
         (least_growth <= linear ? growth * growth : std::pow(growth, further_halves));
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

/// Whether the trial shows what frequencies do that are rare: it meets states many times over that are one in
/// a thousand.
bool shows_rare_states(const judgement& found, Eigen::Index size) {
  constexpr double many_states = 100'000;
  return static_cast<double>(found.trajectories) * static_cast<double>(found.steps) *
             static_cast<double>(size) >=
         many_states;
}

/// Number of steps over which the linear criterion bounds growth.
constexpr std::int64_t linear_steps = 10'000;

/// Whether the trial shows what the linear criterion foretells: it is as long, and meets rare states.
bool shows_instability(const judgement& found, Eigen::Index size) {
  return found.steps >= linear_steps && shows_rare_states(found, size);
}

/// The rules, in this order.
void decide(judgement& found, Eigen::Index size, double least_growth) {
  const auto say = [&](step_verdict verdict, std::string reason) {
    found.verdict = verdict;
    found.reason = std::move(reason);
  };
  if (found.trajectories == 0) {
    return say(step_verdict::not_tried,
               "an accurate method loses every start too: the motion is not confined");
  }
  const std::string loss =
      fmt::format("{} of {} trajectories are lost in {} steps, the first at step {}", found.lost,
                  found.trajectories, found.steps, found.first_lost ? found.first_lost->step : 0);
  if (found.share_lost() > 0.5) return say(step_verdict::unstable, loss);
  if (found.share_lost() > few_lost) return say(step_verdict::loses_trajectories, loss);
  const double few = few_in_trial * static_cast<double>(found.trajectories);
  if (found.diverged > 0 || static_cast<double>(found.lost) > few)
    return say(step_verdict::near_an_edge, loss);
  if (static_cast<double>(found.exceeding) > few) {
    return say(
        step_verdict::near_an_edge,
        fmt::format("the energies of {} of {} trajectories err by more than the kinetic energy, that of "
                    "trajectory {} by {} at step {}",
                    found.exceeding, found.trajectories, found.farthest.trajectory,
                    percent(found.energy_error.largest), found.farthest.step));
  }
  if (const double later = projected(found, least_growth); later > 1.0) {
    return say(
        step_verdict::near_an_edge,
        fmt::format("the energy error grows: one trajectory in fifty errs by {} of the kinetic energy or "
                    "more, in the second half of the steps by {:.3g} times as much as in the first",
                    percent(found.energy_error.nearly_all), found.growth));
  }
  if (!found.linear_objection.empty() && !shows_instability(found, size))
    return say(step_verdict::near_an_edge, found.linear_objection);
  found.verdict = step_verdict::good;
}

}  // namespace

std::int64_t detail::evaluations_of_trial(const model& system, const judging_options& options) {
  constexpr double of_black_box = 2000.0;
  const double cost = detail::is_black_box(system) ? of_black_box : force_cost(system);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(static_cast<double>(options.work) / cost));
}

double judgement::most_lost() const {
  if (trajectories == 0) return 1.0;
  if (lost == trajectories) return 1.0;
  return boost::math::binomial_distribution<>::find_upper_bound_on_p(static_cast<double>(trajectories),
                                                                     static_cast<double>(lost), 1.0 - most);
}

std::string judgement::in_words() const {
  std::string text(to_string(verdict));
  if (!reason.empty()) text += ": " + reason;
  return text;
}

std::string judgement::report() const {
  if (verdict == step_verdict::not_tried) return "not tried: " + reason;
  std::string text = fmt::format("{} trajectories of {} steps, {} lost (at most {})", trajectories, steps,
                                 lost == 0 ? "none" : fmt::format("{}", lost), percent(most_lost()));
  if (unconfined > 0) text += fmt::format(", {} left out whose motion is not confined", unconfined);
  if (energy_was_watched && lost < trajectories) {
    text +=
        fmt::format("; energy errs by {:.2e} of the kinetic energy (median), {:.2e} (95 %), {:.2e} (largest)",
                    energy_error.median, energy_error.most, energy_error.largest);
  }
  return text;
}

struct step_judge::known {
  nysalt::model system;
  states starts;
  double step;
  judging_options options;
  std::int64_t evaluations;
  accurate_motion motion;
  std::optional<detail::stability_guard> guard;  // for words of drifts and kicks
  std::string no_guard;                          // why there is none
  mutable detail::unconfined_starts unconfined;
};

namespace {

/// States from which frequencies are known: some of those along the motion, and then some starts. Of each as
/// many derivatives of the force are taken as there are coordinates, or some forty: in all no more than a
/// tenth of the evaluations of a trial, but for the fewest states.
phase_points states_of(const accurate_motion& motion, const states& starts, Eigen::Index size,
                       std::int64_t evaluations, std::size_t& typical) {
  constexpr Eigen::Index parts = 16'384;  // a large system has many in each state
  constexpr Eigen::Index most_derivatives = 40;
  constexpr Eigen::Index fewest = 8;
  constexpr Eigen::Index most_states = 256;
  const Eigen::Index affordable = evaluations / (10 * std::min(size, most_derivatives)) * 4 / 5;
  const auto wanted =
      static_cast<std::size_t>(std::clamp(std::min(parts / size, affordable), fewest, most_states));
  phase_points result;
  for (const std::size_t k : detail::spread_pairs(motion.seen.size(), wanted))
    result.push_back(motion.seen[k]);
  typical = result.size();
  for (std::size_t k = 0; k < std::min(starts.size(), wanted / 4); ++k) result.push_back(starts[k]);
  return result;
}

detail::stability_guard guard_of(const model& system, const accurate_motion& motion, const states& starts,
                                 std::int64_t evaluations, const nysalt::word& word) {
  std::size_t typical = 0;
  const phase_points at = states_of(motion, starts, size(system), evaluations, typical);
  return {system, at, word, linear_steps, typical == 0 ? at.size() : typical};
}

/// What linear theory says of the method; nothing where the force has no derivatives.
void add_linear(const detail::stability_guard& guard, const nysalt::method& method, Eigen::Index size,
                judgement& found) {
  const nysalt::word& word = method.letters();
  const auto& coefficients = method.coefficients();
  const auto& bands = guard.frequencies(detail::met::often);
  found.frequencies = guard.description();
  constexpr double wider = 1.0 + detail::stability_guard::widened;
  constexpr double narrower = 1.0 - detail::stability_guard::widened;
  for (const auto& band : guard.frequencies()) {
    found.highest_frequency = std::max(found.highest_frequency, band.high / wider);
  }
  found.linear_objection =
      guard.objection(word, coefficients, found.step,
                      shows_rare_states(found, size) ? detail::met::often : detail::met::ever);
  if (word.has_own_letters()) return;
  if (!word.reads_modes) {
    const auto chart = chart_stability(word, coefficients);
    for (const auto& band : bands) {
      const double margin =
          stability_margin(chart.windows, found.step * band.low / narrower, found.step * band.high / wider);
      found.margin = std::min(found.margin.value_or(margin), margin);
    }
  }
  if (found.steps < detail::long_run || found.trajectories == 0) return;
  if (const auto near = detail::near_resonance(word, coefficients, bands, found.step))
    found.resonance = detail::in_words(*near);
}

}  // namespace

step_judge::step_judge(model system, const phase_points& starts, double step,
                       const judging_options& options) {
  if (starts.empty() || !(step > 0.0) || !std::isfinite(step) || options.steps < 1 || options.work < 1 ||
      options.execution.threads < 1) {
    throw std::invalid_argument(
        fmt::format("judge: starts must be given, step must be positive and finite, steps, work and threads "
                    "at least 1, got {} starts, step {}, steps {}, work {} and threads {}",
                    starts.size(), step, options.steps, options.work, options.execution.threads));
  }
  auto made = std::make_unique<known>(known{.system = std::move(system),
                                            .starts = states(starts.begin(), starts.end()),
                                            .step = step,
                                            .options = options,
                                            .evaluations = 0,
                                            .motion = {},
                                            .guard = {},
                                            .no_guard = {},
                                            .unconfined = {}});
  const model& of = made->system;
  made->evaluations = detail::evaluations_of_trial(of, options);
  made->motion = detail::follow(of, made->starts, step, made->evaluations, options);
  try {
    made->guard = guard_of(of, made->motion, made->starts, made->evaluations, nysalt::word("BAB"));
  } catch (const std::invalid_argument& problem) {  // the force has no derivative there
    made->no_guard = problem.what();
  }
  known_ = std::move(made);
}

step_judge::~step_judge() = default;
step_judge::step_judge(step_judge&&) noexcept = default;
step_judge& step_judge::operator=(step_judge&&) noexcept = default;

judgement step_judge::of(const method& method) const {
  const auto& [system, starts, step, options, evaluations, motion, guard, no_guard, unconfined] = *known_;
  const nysalt::word& word = method.letters();
  judgement found;
  found.step = step;
  const detail::trial_plan plan =
      detail::plan_of(evaluations, word.evaluations_per_step, std::ssize(starts), options.steps);
  found.steps = plan.steps;
  found.energy_was_watched = options.watches_energy && !system.bath().acts() && motion.kinetic_energy > 0.0;
  found.kinetic_energy = motion.kinetic_energy;
  auto courses = detail::run_trial({system, starts, step, plan, motion, found.energy_was_watched, options},
                                   method, unconfined);
  // Each letter rounds H once at most, in one direction at worst.
  const double rounding = static_cast<double>(plan.steps) * static_cast<double>(word.length) *
                          std::numeric_limits<double>::epsilon();
  const double least_growth = summarise(courses, rounding, found);
  found.frequencies = no_guard;
  if (word.reads_modes || word.has_own_letters()) {
    try {
      add_linear(guard_of(system, motion, starts, evaluations, word), method, size(system), found);
    } catch (const std::invalid_argument& problem) {
      found.frequencies = problem.what();
    }
  } else if (guard) {
    add_linear(*guard, method, size(system), found);
  }
  decide(found, size(system), least_growth);
  if (found.holds() && !motion.is_followed && motion.kinetic_energy == 0.0) {
    found.verdict = step_verdict::not_tried;
    found.reason = fmt::format(
        "at a step of {:g} an accurate method does not keep the energy either: the step is far too long",
        detail::finest_step * step);
  }
  return found;
}

judgement judge(const model& system, const phase_points& starts, const method& method, double step,
                const judging_options& options) {
  return step_judge(system, starts, step, options).of(method);
}

}  // namespace nysalt