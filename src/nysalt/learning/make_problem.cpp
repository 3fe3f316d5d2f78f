// SPDX-License-Identifier: BSL-1.0
// From a system, its data and a family to a problem that knows none of them.
#include "nysalt/learning/make_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/detail/served_letters.hpp"
#include "nysalt/learning/fit.hpp"
#include "nysalt/learning/require_valid.hpp"
#include "nysalt/learning/some_states.hpp"
#include "nysalt/learning/sound_force.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/energy_error.hpp"
#include "nysalt/losses/state_error.hpp"
#include "nysalt/methods/frequency_to_fit.hpp"

namespace nysalt {

namespace {

/// What each trajectory adds to the gradient of the loss, by its residuals and by its part in the weights:
/// those of a metric are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out larger
/// by some part counts less by that part. Without this the standard errors are two to three times too small.
template <class Loss>
trajectory_scores scores(const Loss& loss, const Eigen::VectorXd& theta) {
  const Eigen::MatrixXd* deviations = loss.error().weight_deviations;
  const auto by_trajectory = residual_gradients(loss, theta);
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(loss.parameters(), static_cast<Eigen::Index>(loss.residuals()));
  const Eigen::MatrixXd sum = loss.share().sum(by_trajectory, zero);
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      if (deviations != nullptr) result[m] -= sum.col(k) * (*deviations)(k, static_cast<Eigen::Index>(m));
    }
  }
  return {std::move(result), loss.share()};
}

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

/// A summary must not take one loss for another, and names it in a line.
void require_name(const std::string& name) {
  const bool is_taken = name == "state" || name == "energy" || name == "covariance";
  if (!name.empty() && !is_taken && name.find_first_of("\n\r") == std::string::npos) return;
  throw std::invalid_argument(
      fmt::format("learn: an own loss cannot be called '{}': take a name of one line that is none of state, "
                  "energy and covariance",
                  name));
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

template <Scalar R>
learning_problem make_problem(const run_time_family& family, const model& system, const flow_map_data& data,
                              const flow_map_data& held_out, const fit_options& options,
                              const detail::other_loss* other) {
  require_valid(data, system);
  require_valid(held_out, system);
  require_served<model, double>(family.letters, system);
  require_served<model, dual<R, directions_at_a_time>>(family.letters, system);
  if (held_out.step != data.step) {
    throw std::invalid_argument(
        fmt::format("learn: the data have the step {}, the held-out data {}", data.step, held_out.step));
  }
  if (&held_out.share().ranks() != &data.share().ranks()) {
    throw std::invalid_argument("learn: the data and the held-out data must be shared by the same ranks");
  }
  using loss_type = after_steps<R>;
  using metric_type = metric;
  const bool has_data = options.loss.of != loss_choice::kind::covariance;
  const communicator& ranks = data.share().ranks();
  const auto measure = std::make_shared<const metric_type>(system, data, options.coordinates);
  const auto of_state = state_error<R>(*measure);
  const auto error_over = [&](const auto& pairs) {
    return other != nullptr                               ? other->template error<R>()
           : options.loss.of == loss_choice::kind::energy ? energy_error<R>(system, pairs)
                                                          : of_state;
  };
  const auto loss_over = [&](const auto& pairs, const auto& error, int steps, bool overlap = true) {
    const after_steps_options how{.steps = steps, .overlap = overlap, .threads = options.threads};
    return std::make_shared<const loss_type>(family, system, pairs, error, how);
  };
  const int steps = other ? other->steps : options.loss.steps;
  const auto loss = loss_over(data, error_over(data), steps);
  const auto held = loss_over(held_out, error_over(held_out), steps);
  const auto one_step = loss_over(held_out, of_state, 1);
  const auto at_end = loss_over(held_out, of_state, shortest_of(held_out), false);

  // Each function keeps the metric that its loss refers to.
  learning_problem problem{
      .family = family,
      .options = options,
      .step = data.step,
      .loss = [loss, measure](const Eigen::VectorXd& theta) { return squares_at(*loss, theta); },
      .scores = [loss, measure](const Eigen::VectorXd& theta) { return scores(*loss, theta); },
      .held_out = held_out.share(),
      .held_out_losses = [held,
                          measure](const Eigen::VectorXd& theta) { return trajectory_losses(*held, theta); },
      .one_step_loss = [one_step,
                        measure](const Eigen::VectorXd& theta) { return loss_value(*one_step, theta); },
      .loss_at_end = [at_end, measure](const Eigen::VectorXd& theta) { return loss_value(*at_end, theta); },
      .judge = [judging_loss = other || options.loss.of != loss_choice::kind::state ? held : at_end,
                measure](const Eigen::VectorXd& theta) { return loss_value(*judging_loss, theta); },
      .evaluations =
          [=, &ranks, of_data = data.evaluations + held_out.evaluations] {
            return of_data + ranks.total(loss->evaluations() + held->evaluations() + one_step->evaluations() +
                                         at_end->evaluations());
          },
      .trial = {},
      .rival = {},
      .guard = guard_along(system, data, held_out, family.letters.rotates(), options),
      .facts = {}};
  auto starts = std::make_shared<const phase_points>(starts_of_trial(system, data, held_out));
  problem.trial_starts = static_cast<std::int64_t>(starts->size());
  constexpr std::int64_t in_bath = 192;
  if (system.bath().acts()) problem.trial_trajectories = in_bath;
  // Some tenths of a second in lanes. What a black box costs is not known.
  constexpr std::int64_t coordinates_at_once = 400'000'000;
  if (!is_black_box(system)) problem.trial_evaluations = coordinates_at_once / size(system);
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
  problem.rival = [system, family, place, held, measure,
                   run](const tabulated& method) -> std::optional<rival_method> {
    if (method.requires_quadratic_kinetic && !has_quadratic_kinetic(system)) return std::nullopt;
    run_time_family alone(method.name(), method.letters(), method.coefficients());
    if (family.letters.stochastic_letters > 0) {
      if (!place || (*place == placement::middle && alone.letters.length % 2 == 0)) return std::nullopt;
      alone = thermostatted(alone, *place);
    }
    try {
      require_served<model, double>(alone.letters, system);
      require_served<model, dual<R, directions_at_a_time>>(alone.letters, system);
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
    const auto coefficients = alone.coefficients({});
    const loss_type rival_loss(*held, alone);
    rival_method result;
    result.name = method.name();
    result.held_out_losses = trajectory_losses(rival_loss, Eigen::VectorXd());
    result.trial = [run, letters = alone.letters, coefficients](std::int64_t trajectories, std::int64_t n) {
      return run(letters, coefficients, trajectories, n);
    };
    return result;
  };
  if (!has_data) {
    if (has_modes(system) && system.bath().acts()) {
      problem.law.emplace(system, family.letters, data.step);
    } else {
      throw std::invalid_argument(
          fmt::format("the covariance loss needs a system in a bath that tells its modes(), and {} is none",
                      describe(system)));
    }
  }
  fit_summary& facts = problem.facts;
  facts.family = family.name;
  facts.system = data.system;
  facts.reference = data.reference;
  facts.ensemble = data.ensemble;
  facts.coordinates = to_string(options.coordinates);
  facts.loss_name = other ? other->description : options.loss.description();
  facts.is_of_data = has_data;
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
  return problem;
}

}  // namespace

namespace detail {

learning_problem make_learning_problem(const run_time_family& family, const model& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const other_loss* other) {
  if (other != nullptr) {
    require_name(other->name);
    if (options.loss != loss_choice{}) {
      throw std::invalid_argument(
          fmt::format("learn: it is one loss that is minimised, {} or {}: leave the "
                      "loss of the options away",
                      options.loss.description(), other->description));
    }
  }
  if (system.facts().in_lanes_with_slopes && (other == nullptr || other->in_lanes)) {
    return make_problem<lanes>(family, system, data, held_out, options, other);
  }
  return make_problem<double>(family, system, data, held_out, options, other);
}

fit learn(const run_time_family& family, const model& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options, const other_loss* other) {
  require_valid(data, system);
  if (options.check_force) require_sound_force(system, data);
  return solve(make_learning_problem(family, system, data, held_out, options, other));
}

}  // namespace detail

}  // namespace nysalt
