// SPDX-License-Identifier: BSL-1.0
#include "nysalt/judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/near_resonance.hpp"
#include "nysalt/derivatives/stability_margin.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

namespace {

using states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// A run four times as long as the trial is what a verdict is for.
constexpr double longer = 4.0;
/// An energy error that grows in proportion to time exceeds the kinetic energy within `longer` trials from
/// this share of it on.
constexpr double large_error = 1.0 / longer;
/// Up to this share of lost trajectories a method is near an edge, and beyond it loses trajectories.
constexpr double few_lost = 0.02;
constexpr double most = 0.95;  // quantile of energy errors, and confidence of the bound on the share lost
constexpr std::int64_t windows = 16;

/// Median of some numbers, which are put into another order; 0 of none.
double median_of(std::vector<double>& numbers) {
  if (numbers.empty()) return 0.0;
  const auto middle = numbers.begin() + std::ssize(numbers) / 2;
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// How many trajectories of how many steps a trial takes, and what the accurate motion before it.
struct trial_plan {
  std::int64_t trajectories = 0;
  std::int64_t steps = 0;
};

/// Of `evaluations` in all: from the first 512 starts if each is followed for some thousand steps, else from
/// fewer, and then over fewer steps. Fewer than eight trajectories or some hundred steps show nothing.
trial_plan plan_of(std::int64_t evaluations, int of_step, std::int64_t starts, std::int64_t most_steps) {
  constexpr std::int64_t enough = 512;
  constexpr std::int64_t fewest = 8;
  constexpr std::int64_t long_enough = 5'000;
  constexpr std::int64_t shortest = 500;
  const std::int64_t steps_in_all = evaluations / std::max(1, of_step);
  trial_plan plan;
  plan.trajectories = std::clamp(steps_in_all / std::min(long_enough, most_steps), fewest, enough);
  plan.trajectories = std::min(plan.trajectories, starts);
  plan.steps = std::min(most_steps, std::max(shortest, steps_in_all / plan.trajectories));
  return plan;
}

/// Force evaluations that a judge may spend on one method.
std::int64_t evaluations_of(const model& system, const judging_options& options) {
  constexpr std::int64_t of_black_box = 2000;
  return std::max<std::int64_t>(1, options.work / (is_black_box(system) ? of_black_box : size(system)));
}

/// Parts of a step that an accurate method takes: of the highest frequency that is declared less than a
/// radian each, far inside its window.
double parts_of_step(const model& system, double step) {
  double highest = 0.0;
  if (has_frequency_bands(system)) {
    for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  } else if (has_modes(system)) {
    highest = detail::frequency_to_fit(system);
  }
  return std::max(8.0, std::ceil(std::abs(step) * highest));
}
/// Beyond this number of parts no accurate motion is computed: nothing is known of what is lost.
constexpr double most_parts = 64.0;

/// What an accurate motion shows.
struct accurate_motion {
  double kinetic_energy = 0.0;  // median over trajectories and times; 0: not known
  states seen;                  // states along it, typical ones first
};

/// Without a bath.
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

/// A trajectory of a trial.
struct course {
  double initial = 0.0;
  std::array<double, windows> sum{};      // of |H - H_0|
  std::array<double, windows> largest{};  // |H - H_0|
  std::array<double, windows> reads{};
  std::vector<double> last;  // |H - H_0| in the last window
  double largest_of_all = 0.0;
  double magnitude = 0.0;      // of H
  std::int64_t at = 0;         // of the largest
  std::int64_t large_at = -1;  // first read above the kinetic energy
  std::optional<std::int64_t> diverged_at;
  bool is_left_out = false;
};

/// Which of some trajectories an accurate method loses too: at a fine step and, so that it is not its own
/// instability, at a finer one.
template <class T>
std::vector<bool> are_unconfined(const model& system, const states& at, double step, int parts,
                                 std::int64_t steps, const judging_options& options) {
  std::vector<bool> result(at.size(), true);
  for (const int finer : {parts, 4 * parts}) {
    const auto accurate =
        make_stepper(system, tabulated(blanes_moan_s6{}), step / finer, counter_noise(options.seed));
    const auto diverged_at = integrate_ensemble<T>(
        accurate, listed<Eigen::Dynamic>(at),
        {.trajectories = std::ssize(at),
         .steps = finer * steps,
         .every = finer * steps,
         .threads = options.threads},
        1, [](const auto&, std::span<T>) {}, [](auto&&...) {});
    for (std::size_t k = 0; k < at.size(); ++k) result[k] = result[k] && diverged_at[k].has_value();
    if (std::ranges::none_of(result, std::identity{})) break;
  }
  return result;
}

/// Leaves out those of some diverged trajectories that an accurate method loses, too. A few at a time: the
/// first that the motion does not lose decides.
template <class T>
void leave_out_unconfined(const model& system, const states& starts, double step, std::int64_t steps,
                          const judging_options& options, const std::vector<std::size_t>& diverged,
                          std::vector<course>& courses) {
  const double parts = parts_of_step(system, step);
  if (!(parts <= most_parts) || system.bath().acts()) return;
  constexpr std::size_t few = 8;
  for (std::size_t begin = 0; begin < diverged.size(); begin += few) {
    const std::size_t end = std::min(begin + few, diverged.size());
    states some;
    for (std::size_t k = begin; k < end; ++k) some.push_back(starts[diverged[k]]);
    const auto unconfined = are_unconfined<T>(system, some, step, static_cast<int>(parts), steps, options);
    for (std::size_t k = begin; k < end; ++k) courses[diverged[k]].is_left_out = unconfined[k - begin];
    if (!std::ranges::all_of(unconfined, std::identity{})) return;
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

/// Runs a method in blocks of trajectories. Stops after one in which most of all are lost, and after two if
/// these are clear: of the share lost more is not known then than that it is small.
template <class T>
std::vector<course> run_trial(const model& system, const tabulated& method, double step, const states& starts,
                              const trial_plan& plan, double kinetic_energy, const judging_options& options) {
  constexpr std::int64_t block = 64;
  constexpr std::int64_t every = 7;  // no low-order resonance has this period
  const bool watches = kinetic_energy > 0.0;
  const listed<Eigen::Dynamic> all(starts);
  const auto stepper = make_stepper(system, method, step, counter_noise(options.seed));
  std::vector<course> courses;
  const auto read = [&](const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) {
    if (watches) numbers[0] = energy<T>(system, x);
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
    const auto diverged_at = integrate_ensemble<T>(stepper, all,
                                                   {.trajectories = count,
                                                    .steps = plan.steps,
                                                    .every = watches ? every : plan.steps,
                                                    .seed = options.seed,
                                                    .threads = options.threads,
                                                    .first = first},
                                                   1, read, take);
    std::vector<std::size_t> diverged;
    for (std::size_t k = 0; k < diverged_at.size(); ++k) {
      const std::size_t m = static_cast<std::size_t>(first) + k;
      courses[m].diverged_at = diverged_at[k];
      if (diverged_at[k]) diverged.push_back(m);
    }
    leave_out_unconfined<T>(system, starts, step, plan.steps, options, diverged, courses);
    for (std::int64_t m = first; m < first + count; ++m) {
      const course& one = courses[static_cast<std::size_t>(m)];
      if (one.diverged_at && !one.is_left_out) ++lost;
    }
    if (first == block && are_clear(courses, kinetic_energy)) break;
  }
  return courses;
}

/// Puts what the trajectories did into the judgement.
void summarise(std::vector<course>& courses, double rounding, judgement& found) {
  const double scale = found.kinetic_energy;
  std::vector<double> errors;
  std::array<std::vector<double>, windows> levels;
  double first_half = 0.0;
  double second_half = 0.0;
  for (std::size_t m = 0; m < courses.size(); ++m) {
    course& one = courses[m];
    if (one.is_left_out) {
      ++found.unconfined;
      continue;
    }
    ++found.trajectories;
    bool is_lost = one.diverged_at.has_value();
    if (is_lost) ++found.diverged;
    if (found.energy_was_watched && !is_lost) {
      is_lost = median_of(one.last) > scale + rounding * one.magnitude;
      errors.push_back(one.largest_of_all / scale);
      if (errors.back() > found.energy_error.largest) {
        found.energy_error.largest = errors.back();
        found.farthest = {static_cast<std::int64_t>(m), one.at};
      }
      for (std::size_t w = 0; w < levels.size(); ++w) {
        if (one.reads[w] > 0.0) levels[w].push_back(one.sum[w] / one.reads[w] / scale);
        const double excess = std::max(0.0, one.largest[w] - rounding * one.magnitude);
        double& half = 2 * w < levels.size() ? first_half : second_half;
        half = std::max(half, excess);
      }
    }
    if (!is_lost) continue;
    ++found.lost;
    if (!found.first_lost) {
      found.first_lost = {static_cast<std::int64_t>(m),
                          one.diverged_at.value_or(std::max<std::int64_t>(0, one.large_at))};
    }
  }
  if (errors.empty()) return;
  const auto rank = static_cast<std::size_t>(most * static_cast<double>(errors.size()));
  found.energy_error.median = median_of(errors);
  std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(rank));
  found.energy_error.most = errors[rank];
  found.growth = second_half > 0.0 ? second_half / first_half : 0.0;
  std::array<double, windows> level{};
  for (std::size_t w = 0; w < levels.size(); ++w) level[w] = median_of(levels[w]);
  found.drift = slope_of(level);
}

/// The largest energy error after a run `longer` times as long: a power of time grows by its square for
/// another two doublings, and what grows faster than time itself is taken to be exponential.
double projected(const judgement& found) {
  constexpr double linear = 2.0;  // growth of what is proportional to time
  const double growth = std::max(1.0, found.growth);
  const double further_halves = 2.0 * longer - 2.0;
  return found.energy_error.largest * (growth <= linear ? growth * growth : std::pow(growth, further_halves));
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

/// The rules, in this order.
void decide(judgement& found) {
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
  if (found.lost > 0) return say(step_verdict::near_an_edge, loss);
  if (found.energy_error.largest > 1.0) {
    return say(
        step_verdict::near_an_edge,
        fmt::format("the energy of trajectory {} errs by {} of the kinetic energy at step {}",
                    found.farthest.trajectory, percent(found.energy_error.largest), found.farthest.step));
  }
  if (found.energy_error.most > large_error) {
    return say(step_verdict::near_an_edge,
               fmt::format("the energies of one trajectory in twenty err by {} of the kinetic energy or more",
                           percent(found.energy_error.most)));
  }
  if (const double later = projected(found); later > 1.0) {
    return say(step_verdict::near_an_edge,
               fmt::format("the energy error grows: its largest value, {} of the kinetic energy, is {:.3g} "
                           "times that of the first half of the steps",
                           percent(found.energy_error.largest), found.growth));
  }
  if (!found.linear_objection.empty()) return say(step_verdict::near_an_edge, found.linear_objection);
  found.verdict = step_verdict::good;
}

}  // namespace

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
  std::optional<stability_guard> guard;  // for words of drifts and kicks
  std::string no_guard;                  // why there is none
};

namespace {

/// States from which frequencies are known: some of those along the motion, and then some starts.
phase_points states_of(const accurate_motion& motion, const states& starts, Eigen::Index size,
                       std::size_t& typical) {
  constexpr Eigen::Index parts = 16'384;  // a large system has many in each state
  const auto wanted = static_cast<std::size_t>(std::clamp<Eigen::Index>(parts / size, 8, 256));
  phase_points result;
  for (const std::size_t k : detail::spread_pairs(motion.seen.size(), wanted))
    result.push_back(motion.seen[k]);
  typical = result.size();
  for (std::size_t k = 0; k < std::min(starts.size(), wanted / 4); ++k) result.push_back(starts[k]);
  return result;
}

stability_guard guard_of(const model& system, const accurate_motion& motion, const states& starts,
                         const run_time_word& word) {
  std::size_t typical = 0;
  const phase_points at = states_of(motion, starts, size(system), typical);
  return {system, at, word, 10'000, typical == 0 ? at.size() : typical};
}

/// What linear theory says of the method; nothing where the force has no derivatives.
void add_linear(const stability_guard& guard, const tabulated& method, Eigen::Index size, judgement& found) {
  const run_time_word& word = method.letters();
  const auto& coefficients = method.coefficients();
  const auto& bands = guard.frequencies(met::often);
  found.frequencies = guard.description();
  constexpr double wider = 1.0 + stability_guard::widened;
  constexpr double narrower = 1.0 - stability_guard::widened;
  for (const auto& band : guard.frequencies()) {
    found.highest_frequency = std::max(found.highest_frequency, band.high / wider);
  }
  // A trial shows what rare frequencies do if it meets states many times over that are one in a thousand.
  constexpr double many_states = 100'000;
  const bool shows_rare_states = static_cast<double>(found.trajectories) * static_cast<double>(found.steps) *
                                     static_cast<double>(size) >=
                                 many_states;
  found.linear_objection =
      guard.objection(word, coefficients, found.step, shows_rare_states ? met::often : met::ever);
  if (word.has_own_letters()) return;
  if (!has_rotation(word)) {
    const auto chart = chart_stability(word, coefficients);
    for (const auto& band : bands) {
      const double margin =
          stability_margin(chart.windows, found.step * band.low / narrower, found.step * band.high / wider);
      found.margin = std::min(found.margin.value_or(margin), margin);
    }
  }
  if (found.steps < long_run || found.trajectories == 0) return;
  if (const auto near = near_resonance(word, coefficients, bands, found.step))
    found.resonance = in_words(*near);
}

}  // namespace

step_judge::step_judge(model system, const phase_points& starts, double step,
                       const judging_options& options) {
  if (starts.empty() || !(step > 0.0) || !std::isfinite(step) || options.steps < 1 || options.work < 1 ||
      options.threads < 1) {
    throw std::invalid_argument(
        fmt::format("judge: starts must be given, step must be positive and finite, steps, work and threads "
                    "at least 1, got {} starts, step {}, steps {}, work {} and threads {}",
                    starts.size(), step, options.steps, options.work, options.threads));
  }
  auto made = std::make_unique<known>(known{.system = std::move(system),
                                            .starts = states(starts.begin(), starts.end()),
                                            .step = step,
                                            .options = options,
                                            .evaluations = 0,
                                            .motion = {},
                                            .guard = {},
                                            .no_guard = {}});
  const model& of = made->system;
  made->evaluations = evaluations_of(of, options);
  made->motion = detail::with_scalar_of(
      of, [&]<class T>(T) { return follow<T>(of.base(), made->starts, step, made->evaluations, options); });
  try {
    made->guard = guard_of(of, made->motion, made->starts, run_time_word("BAB"));
  } catch (const std::invalid_argument& problem) {  // the force has no derivative there
    made->no_guard = problem.what();
  }
  known_ = std::move(made);
}

step_judge::~step_judge() = default;
step_judge::step_judge(step_judge&&) noexcept = default;
step_judge& step_judge::operator=(step_judge&&) noexcept = default;

double step_judge::step() const { return known_->step; }

judgement step_judge::of(const tabulated& method) const {
  const auto& [system, starts, step, options, evaluations, motion, guard, no_guard] = *known_;
  const run_time_word& word = method.letters();
  judgement found;
  found.step = step;
  const trial_plan plan = plan_of(evaluations, word.evaluations_per_step, std::ssize(starts), options.steps);
  found.steps = plan.steps;
  found.energy_was_watched = options.watches_energy && !system.bath().acts() && motion.kinetic_energy > 0.0;
  found.kinetic_energy = motion.kinetic_energy;
  auto courses = detail::with_scalar_of(system, [&]<class T>(T) {
    return run_trial<T>(system, method, step, starts, plan,
                        found.energy_was_watched ? motion.kinetic_energy : 0.0, options);
  });
  // Each letter rounds H once at most, in one direction at worst.
  const double rounding = static_cast<double>(plan.steps) * static_cast<double>(word.length) *
                          std::numeric_limits<double>::epsilon();
  summarise(courses, rounding, found);
  found.frequencies = no_guard;
  if (has_rotation(word) || word.has_own_letters()) {
    try {
      add_linear(guard_of(system, motion, starts, word), method, size(system), found);
    } catch (const std::invalid_argument& problem) {
      found.frequencies = problem.what();
    }
  } else if (guard) {
    add_linear(*guard, method, size(system), found);
  }
  decide(found);
  return found;
}

judgement judge(const model& system, const phase_points& starts, const tabulated& method, double step,
                const judging_options& options) {
  return step_judge(system, starts, step, options).of(method);
}

}  // namespace nysalt
