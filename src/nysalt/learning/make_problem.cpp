// SPDX-License-Identifier: BSL-1.0
// From a system, its data and a family to a problem that knows none of them.
#include "nysalt/learning/make_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "../losses/data_loss.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "nysalt/learning/fit.hpp"
#include "nysalt/learning/require_valid.hpp"
#include "nysalt/learning/some_states.hpp"
#include "nysalt/learning/sound_force.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"

namespace nysalt {

namespace {

/// Whether the first trajectory, which rank 0 has, is the same. In a bath other noise makes another of the
/// same start.
bool begin_alike(const flow_map_data& a, const flow_map_data& b) {
  const communicator& ranks = a.share().ranks();
  bool result = false;
  if (ranks.is_first()) {
    const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
    result = a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
  }
  broadcast(ranks, result);
  return result;
}

/// The root mean square error of the reference, where it was checked: against its finer self, along noisy
/// paths with error_over_difference.
double error_of_reference(const flow_map_data& data, const metric& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    double& of_trajectory = squares[data.trajectory_of(pair)];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  const auto checks = data.share().ranks().total(std::ssize(data.finer));
  const double difference = std::sqrt(data.share().sum(squares) / static_cast<double>(checks));
  return data.noise_parts > 0 ? error_over_difference * difference : difference;
}

/// The number of steps of the shortest trajectory.
int shortest_of(const flow_map_data& data) {
  std::size_t least = data.all_pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  const auto of_all = data.share().ranks().least(static_cast<std::int64_t>(least));
  return static_cast<int>(std::max<std::int64_t>(of_all, 1));
}

/// Those that were asked for; else the energy coordinates where the loss is of them and they exist, else qp.
coordinates coordinates_of(const model& system, const fit_options& options, bool is_of_energy_norm) {
  if (options.coordinates) return *options.coordinates;
  return is_of_energy_norm && has_modes(system) ? coordinates::energy : coordinates::qp;
}

/// A summary must not take one loss for another, and names it in a line.
void require_name(const std::string& name) {
  std::vector<std::string_view> taken;
  for (const loss_kind* kind : losses()) taken.push_back(kind->name);
  const bool is_taken = std::ranges::find(taken, name) != taken.end();
  if (!name.empty() && !is_taken && name.find_first_of("\n\r") == std::string::npos) return;
  const auto last = taken.back();
  taken.pop_back();
  throw std::invalid_argument(fmt::format(
      "learn: an own loss cannot be called '{}': take a name of one line that is none of {} and {}", name,
      fmt::join(taken, ", "), last));
}

/// Where a word has its letters O; nothing if it has none, or not as placement says.
std::optional<placement> placement_in(const run_time_word& word) {
  const std::string& letters = word.letters();
  constexpr char o = ornstein_uhlenbeck::letter;
  if (word.stochastic_letters == 2 && letters.front() == o && letters.back() == o)
    return placement::symmetric;
  if (word.stochastic_letters != 1) return std::nullopt;
  return letters.back() == o ? placement::end : placement::middle;
}

/// The guard that knows the frequencies along both sets of data.
stability_guard guard_along(const model& system, const flow_map_data& data, const flow_map_data& held_out,
                            bool rotations, const fit_options& options) {
  auto [states, typical] = some_states(system, data);
  states.append(some_states(system, held_out).states);
  // Over ten thousand steps, as at first: what grows more slowly a trial run tells.
  constexpr std::int64_t most_steps = 10'000;
  return {system, states, rotations, std::min(options.planned_steps, most_steps), typical};
}

/// Whether the letters are served, in lanes or one by one, with their derivatives by theta.
void require_served_with_slopes(const run_time_word& letters, const model& system, bool in_lanes) {
  require_served<model, double>(letters, system);
  if (in_lanes) {
    require_served<model, detail::lanes_with_slopes>(letters, system);
  } else {
    require_served<model, dual<double, directions_at_a_time>>(letters, system);
  }
}

/// The mean over stretches and times of the squared distance from where a stretch begins.
double motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how) {
  const auto last = static_cast<std::size_t>(how.steps.back());
  const stretch_starts starts(data, last, static_cast<std::size_t>(how.apart));
  const double terms =
      static_cast<double>(data.share().ranks().total(std::ssize(starts.pairs)) * std::ssize(how.steps));
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = starts.first_of[m]; n < starts.first_of[m + 1]; ++n) {
      const std::size_t first = starts.pairs[n];
      for (const int steps : how.steps) {
        const auto& finish = data.finish[first + static_cast<std::size_t>(steps) - 1];
        measure.residual(finish.q, finish.p, data.start[first], r.data());
        for (const double x : r) squares[m] += x * x / terms;
      }
    }
  }
  return data.share().sum(squares);
}

/// The stages of a search look at some of the trajectories alone, 16 at least, where all have more
/// coordinates together than tell where minima lie: a hundred trajectories of a dozen.
int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates) {
  constexpr std::int64_t enough = 1200;  // coordinates of all trajectories
  constexpr std::int64_t least = 16;
  const std::int64_t all = data.share().total();
  return static_cast<int>(
      std::clamp<std::int64_t>(all * coordinates / enough, 1, std::max<std::int64_t>(all / least, 1)));
}

/// Of a problem over trajectories of so many steps at most. `before` counts the evaluations of what was tried
/// over more.
learning_problem make_problem(
    const run_time_family& family, const model& system, const flow_map_data& data,
    const flow_map_data& held_out, fit_options options, const detail::other_loss* other, bool in_lanes,
    int most_steps = std::numeric_limits<int>::max(),
    const std::function<std::int64_t()>& before = [] { return 0; }) {
  require_valid(data, system);
  require_valid(held_out, system);
  require_served_with_slopes(family.letters, system, in_lanes);
  if (held_out.step != data.step) {
    throw std::invalid_argument(
        fmt::format("learn: the data have the step {}, the held-out data {}", data.step, held_out.step));
  }
  if (&held_out.share().ranks() != &data.share().ranks()) {
    throw std::invalid_argument("learn: the data and the held-out data must be shared by the same ranks");
  }
  const loss_choice chosen = options.loss.value_or(usual_loss(system.bath()));
  const loss_kind& kind = *chosen.kind;
  if (other == nullptr && !family.letters.is_symplectic && !kind.is_for_sampling) {
    throw std::invalid_argument(sentence(
        "learn: {} has the letter D, and is not symplectic: it is for sampling; take the loss acceptance or "
        "energy:K, or the family fg_chin",
        family.name));
  }
  const int shortest = std::min({shortest_of(data), shortest_of(held_out), most_steps});
  if (other == nullptr && kind.is_of_proposals) {
    options.planned_steps = std::min<std::int64_t>(options.planned_steps, shortest);
  }
  const communicator& ranks = data.share().ranks();
  const coordinates which = coordinates_of(system, options, other == nullptr && kind.is_of_energy_norm);
  const auto measure = std::make_shared<const metric>(system, data, which);
  const auto inputs = [&](const flow_map_data& pairs, after_steps_options how) {
    how.threads = options.threads;
    return detail::loss_inputs{family, system, pairs, measure, std::move(how), in_lanes};
  };
  const auto loss_over = [&](const flow_map_data& pairs, const after_steps_options& how) {
    const auto from = inputs(pairs, how);
    if (other == nullptr) return kind.over_data(from);
    return in_lanes ? after_steps_of(from, *other->in_lanes) : after_steps_of(from, *other->one_by_one);
  };
  const auto stages =
      other == nullptr ? kind.stages(chosen.steps, shortest) : after_each_step(other->steps, shortest);
  std::vector<detail::data_loss> losses_of_stages;
  const int every = trajectories_apart(data, size(system));
  for (auto stage : stages) {
    stage.every = every;
    losses_of_stages.push_back(loss_over(data, stage));
  }
  const detail::data_loss loss = every == 1 ? losses_of_stages.back() : loss_over(data, stages.back());
  const bool has_whole_trajectories = other == nullptr && kind.is_shortened && shortest > 1;
  std::optional<detail::data_loss> one_step_before;
  if (has_whole_trajectories) {
    one_step_before = loss_over(data, {.steps = {1}, .apart = std::max(shortest / 8, 1), .every = every});
  }
  const auto held = loss_over(held_out, stages.back());
  const auto one_step = detail::of_states(inputs(held_out, {}));
  const int end = shortest_of(held_out);
  const auto at_end = detail::of_states(inputs(held_out, {.steps = {end}, .apart = end}));
  const auto judge = other == nullptr ? kind.judge : judge_of_minima::held_out_loss;
  const auto passes = [=] {
    std::int64_t here = held.evaluations() + one_step.evaluations() + at_end.evaluations() + before();
    for (const auto& stage : losses_of_stages) here += stage.evaluations();
    if (every > 1) here += loss.evaluations();
    if (one_step_before) here += one_step_before->evaluations();
    return here;
  };

  learning_problem problem{.family = family,
                           .options = options,
                           .step = data.step,
                           .loss = loss.of_theta,
                           .scores = loss.scores,
                           .held_out = held_out.share(),
                           .held_out_losses = held.by_trajectory,
                           .one_step_loss = one_step.value,
                           .loss_at_end = at_end.value,
                           .judge = judge == judge_of_minima::held_out_end    ? at_end.value
                                    : judge == judge_of_minima::training_loss ? loss.value
                                                                              : held.value,
                           .evaluations =
                               [=, &ranks, of_data = data.evaluations + held_out.evaluations] {
                                 return of_data + ranks.total(passes());
                               },
                           .trial = {},
                           .rival = {},
                           .guard = guard_along(system, data, held_out, family.letters.rotates(), options),
                           .facts = {}};
  const bool asks_data = other != nullptr || kind.asks_data();
  for (const auto& stage : losses_of_stages) {
    if (asks_data) problem.earlier_losses.push_back(stage.of_theta);
  }
  if (one_step_before) problem.one_step_before = one_step_before->of_theta;
  auto starts = std::make_shared<const phase_points>(starts_of_trial(system, data, held_out));
  problem.trial_starts = static_cast<std::int64_t>(starts->size());
  constexpr std::int64_t in_bath = 192;
  if (system.bath().acts()) problem.trial_trajectories = in_bath;
  // Some tenths of a second in lanes. What a black box costs is not known.
  constexpr std::int64_t coordinates_at_once = 400'000'000;
  problem.is_of_black_box = is_black_box(system);
  problem.is_in_bath = system.bath().acts();
  if (!problem.is_of_black_box) problem.trial_evaluations = coordinates_at_once / size(system);
  if (has_modes(system)) problem.frequency_to_fit = detail::frequency_to_fit(system);
  const auto run = [system, starts, step = data.step, seed = held_out.seed, threads = options.threads](
                       const run_time_word& letters, const std::vector<double>& coefficients,
                       std::int64_t trajectories, std::int64_t steps) {
    phase_points first;
    for (std::int64_t k = 0; k < trajectories; ++k) first.push_back((*starts)[static_cast<std::size_t>(k)]);
    const tabulated method("trial", letters, coefficients, {1, false, false});
    return trial_run(system, method, step, first, {.steps = steps, .seed = seed, .threads = threads});
  };
  problem.trial = [run, letters = family.letters](const std::vector<double>& coefficients,
                                                  std::int64_t trajectories, std::int64_t steps) {
    return run(letters, coefficients, trajectories, steps);
  };
  const auto place = placement_in(family.letters);
  problem.rival = [system, family, place, held, in_lanes,
                   run](const tabulated& method) -> std::optional<rival_method> {
    if (method.requires_quadratic_kinetic && !has_quadratic_kinetic(system)) return std::nullopt;
    run_time_family alone(method.name(), method.letters(), method.coefficients());
    if (family.letters.stochastic_letters > 0) {
      if (!place || alone.letters.is_processed()) return std::nullopt;
      if (*place == placement::middle && alone.letters.length % 2 == 0) return std::nullopt;
      alone = thermostatted(alone, *place);
    }
    try {
      require_served_with_slopes(alone.letters, system, in_lanes);
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
    const auto coefficients = alone.coefficients({});
    rival_method result;
    result.name = method.name();
    result.held_out_losses = held.by_trajectory_of(alone);
    result.trial = [run, letters = alone.letters, coefficients](std::int64_t trajectories, std::int64_t n) {
      return run(letters, coefficients, trajectories, n);
    };
    return result;
  };
  if (!asks_data) {  // it is its own judge
    problem.loss = kind.without_data(system, family, data.step);
    problem.judge = [law = problem.loss](const Eigen::VectorXd& theta) { return law(theta).value; };
    if (kind.is_of_proposals)
      problem.earlier_losses = {problem.loss};  // from many starts, as it costs little
  }
  fit_summary& facts = problem.facts;
  facts.family = family.name;
  facts.system = data.system;
  facts.reference = data.reference;
  facts.ensemble = data.ensemble;
  facts.coordinates = to_string(which);
  facts.loss_name = other ? other->description : chosen.description();
  facts.is_of_data = asks_data;
  facts.derivatives = system.facts().derivative_source;
  facts.step = data.step;
  facts.seed = data.seed;
  facts.held_out_seed = held_out.seed;
  facts.held_out_is_new = !begin_alike(data, held_out);
  facts.guard = problem.guard.description();
  facts.coordinates_used = measure->residuals();
  facts.dropped = measure->dropped();
  facts.samples = data.all_pairs();
  facts.trajectories = static_cast<std::size_t>(data.share().total());
  facts.held_out_samples = held_out.all_pairs();
  facts.reference_checked = ranks.total(std::ssize(data.finer)) > 0;
  if (facts.reference_checked) facts.reference_error = error_of_reference(data, *measure);
  facts.data_seconds = data.seconds + held_out.seconds;
  facts.loss_steps = stages.back().steps.back();
  if (has_whole_trajectories) {
    constexpr double lost = 0.0025;  // an error of a twentieth of the motion
    problem.follows = [value = loss.value, most = lost * motion_in(data, *measure, stages.back())](
                          const Eigen::VectorXd& theta) { return value(theta) <= most; };
    problem.shorter = std::make_shared<learning_problem>(
        make_problem(family, system, data, held_out, options, other, in_lanes, shortest / 4 + 1, passes));
  }
  return problem;
}

}  // namespace

namespace detail {

learning_problem make_learning_problem(const run_time_family& family, const model& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const other_loss* other) {
  if (other != nullptr) {
    require_name(other->name);
    if (options.loss) {
      throw std::invalid_argument(
          fmt::format("learn: it is one loss that is minimised, {} or {}: leave the "
                      "loss of the options away",
                      options.loss->description(), other->description));
    }
  }
  const bool in_lanes = system.facts().in_lanes_with_slopes && (other == nullptr || other->in_lanes);
  return make_problem(family, system, data, held_out, options, other, in_lanes);
}

fit learn(const run_time_family& family, const model& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options, const other_loss* other) {
  require_valid(data, system);
  if (options.check_force) require_sound_force(system, data);
  return solve(make_learning_problem(family, system, data, held_out, options, other));
}

}  // namespace detail

}  // namespace nysalt
