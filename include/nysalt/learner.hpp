// SPDX-License-Identifier: BSL-1.0
// Fits a family to the flow map of a system at a step.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/learning/objection.hpp"
#include "nysalt/learning/search.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/stationary_covariance.hpp"
#include "nysalt/method.hpp"
#include "nysalt/tree_sum.hpp"

namespace nysalt {

/// How to search. What is empty is the family's own.
struct fit_options {
  nysalt::coordinates coordinates = nysalt::coordinates::qp;
  loss_choice loss{};
  std::optional<Eigen::VectorXd> start{};          // instead of the family's own starts
  std::vector<named_parameters> further_starts{};  // beside them, such as the optimum at a smaller step
  int random_starts = 0;                           // beside all these
  std::vector<std::optional<double>> fixed{};      // a value for each parameter that is not to be learned
  bool guarded = true;  // false: an unstable optimum is found, and said not to be usable
  std::uint64_t seed = 1;
  int max_iterations = 200;
  int threads = 1;  // changes no bit of what is learned
};

struct fit {
  Eigen::VectorXd theta;
  fit_summary summary;
};

/// The same options with parameters as the family holds them.
template <Family F>
struct learn_options {
  nysalt::coordinates coordinates = nysalt::coordinates::qp;
  parameters_of<F> start = F::start();
  std::array<std::optional<double>, static_cast<std::size_t>(F::parameters)> fixed{};
  int max_iterations = 200;
  int threads = 1;
  loss_choice loss{};
  bool classical_starts = true;
  int random_starts = 0;
  bool guarded = true;
  std::uint64_t seed = 1;
};

template <Family F>
struct learned {
  tuned_method<F> method;
  fit_summary summary;
};

namespace detail {

/// What each trajectory adds to the gradient of the loss, by its residuals and by its part in the weights:
/// these are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out larger by some part
/// counts less by that part. Without this the standard errors are two to three times too small.
template <class Loss, int N>
std::vector<Eigen::VectorXd> scores(const Loss& loss, const metric<N>& measure,
                                    const Eigen::VectorXd& theta) {
  const auto by_trajectory = residual_gradients(loss, theta);
  const Eigen::MatrixXd sum = tree_sum(by_trajectory);
  const bool is_weighted = sum.cols() == measure.residuals();  // an energy is not
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      if (is_weighted) result[m] -= sum.col(k) * measure.weight_deviations()(k, static_cast<Eigen::Index>(m));
    }
  }
  return result;
}

/// Whether the first trajectory is the same. In a bath other noise makes another of the same start.
template <int N>
bool begin_alike(const flow_map_data<N>& a, const flow_map_data<N>& b) {
  const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
  return a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
}

/// The root mean square error of the reference, where it was checked.
template <int N>
double error_of_reference(const flow_map_data<N>& data, const metric<N>& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    const auto next = std::upper_bound(data.first_of.begin(), data.first_of.end(), pair);
    double& of_trajectory = squares[static_cast<std::size_t>(next - data.first_of.begin()) - 1];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  return std::sqrt(tree_sum(squares) / static_cast<double>(data.finer.size()));
}

/// The number of steps of the shortest trajectory.
template <int N>
int shortest_of(const flow_map_data<N>& data) {
  std::size_t least = data.pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  return static_cast<int>(std::max<std::size_t>(least, 1));
}

/// Some hundred states of the data, for what is asked along them.
template <int N>
std::vector<phase_point<double, N>> some_states(const flow_map_data<N>& data) {
  constexpr std::size_t most = 128;
  std::vector<phase_point<double, N>> result;
  for (std::size_t n = 0; n < data.pairs(); n += data.pairs() / most + 1) result.push_back(data.start[n]);
  return result;
}

/// Of the law that a thermostatted word keeps on the quadratic part.
template <System S>
objective covariance_objective(const run_time_family& family, const S& system, double step) {
  if constexpr (HasBath<S> && HasModes<S>) {
    return objective_of(stationary_covariance(system, family.letters, step), family);
  } else {
    throw std::invalid_argument(
        fmt::format("the covariance loss needs a system in a bath that tells its modes(), and {} is none",
                    describe(system)));
  }
}

inline std::vector<named_parameters> starts_of(const run_time_family& family, const fit_options& options,
                                               const std::vector<Eigen::Index>& free) {
  std::vector<named_parameters> starts = family.starts;
  if (options.start) starts = {{"start", *options.start}};
  starts.insert(starts.end(), options.further_starts.begin(), options.further_starts.end());
  for (auto& start : starts) {
    for (std::size_t k = 0; k < options.fixed.size(); ++k) {
      if (options.fixed[k]) start.theta[static_cast<Eigen::Index>(k)] = *options.fixed[k];
    }
  }
  for (int n = 0; n < options.random_starts; ++n) {
    const auto number = static_cast<std::uint64_t>(n);
    starts.push_back({fmt::format("random {}", n + 1),
                      random_start(family, starts.front().theta, free, options.seed, number)});
  }
  return starts;
}

inline void require_sound(const run_time_family& family, const fit_options& options) {
  if (options.max_iterations < 0 || options.random_starts < 0) {
    throw std::invalid_argument(
        fmt::format("learn: max_iterations and random_starts must not be negative, got {} and {}",
                    options.max_iterations, options.random_starts));
  }
  const auto count = static_cast<std::size_t>(family.parameters());
  if ((options.start && options.start->size() != family.parameters()) ||
      (!options.fixed.empty() && options.fixed.size() != count)) {
    throw std::invalid_argument(fmt::format(
        "learn: {} has {} parameters, start and fixed values must be as many", family.name, count));
  }
  require_in_range(family, starts_of(family, options, {}).front().theta);
}

}  // namespace detail

/// theta that minimises a loss over `data`, by default the one-step loss [li_lu_tao_ye_2023, section 3.1]. Of
/// several starts (the family's own, its classical members, and what the options add) it is the minimum with
/// the least mean square error at the end of the held-out trajectories, which should come from another seed,
/// among those that the stability_guard admits; see learning/search.hpp for where it admits none.
///
/// Throws std::invalid_argument if the data are of another system, of two steps or not finite, if the system
/// does not serve the family's letters, or if the coordinates, the loss, a start, a fixed value,
/// max_iterations or threads cannot be. A fit that cannot be trusted is returned with usable = false. Cost:
/// some 20 to 80 passes over the data for each start, each a plain step with derivatives a pair; R carries
/// the pairs, and changes no bit. Memory: two or three copies of the data.
template <SeparableSystem S, Scalar R = scalar_of_passes<S>>
fit learn(const run_time_family& family, const S& system, const flow_map_data<S::dimension>& data,
          const flow_map_data<S::dimension>& held_out, const fit_options& options = {}) {
  const auto began = std::chrono::steady_clock::now();
  require_valid(data, system);
  require_valid(held_out, system);
  require_served<S, double>(family.letters, system);
  detail::require_sound(family, options);
  if (held_out.step != data.step) {
    throw std::invalid_argument(
        fmt::format("learn: the data have the step {}, the held-out data {}", data.step, held_out.step));
  }
  using loss_type = after_steps<S, R>;
  const bool has_data = options.loss.of != loss_choice::kind::covariance;
  const metric<S::dimension> measure(system, data, options.coordinates);
  const after_steps_options of_loss{.steps = options.loss.steps,
                                    .energy = options.loss.of == loss_choice::kind::energy,
                                    .overlap = true,
                                    .threads = options.threads};
  const loss_type loss(family, system, data, measure, of_loss);
  const loss_type held_out_loss(family, system, held_out, measure, of_loss);
  const loss_type judge(
      family, system, held_out, measure,
      {.steps = detail::shortest_of(held_out), .overlap = false, .threads = options.threads});
  const stability_guard guard(system, detail::some_states(data));

  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < family.parameters(); ++k) {
    if (options.fixed.empty() || !options.fixed[static_cast<std::size_t>(k)]) free.push_back(k);
  }
  const auto starts = detail::starts_of(family, options, free);
  search_task task{
      .family = &family,
      .loss = has_data ? objective_of(loss) : detail::covariance_objective(family, system, data.step),
      .judge = [&](const Eigen::VectorXd& theta) { return loss_value(judge, theta); },
      .admits =
          [&](const Eigen::VectorXd& theta) {
            return !options.guarded || guard.admits(family.letters, family.coefficients(theta), data.step);
          },
      .free = free,
      .max_iterations = options.max_iterations};
  if (!has_data) {  // it is its own judge
    task.judge = [objective = task.loss](const Eigen::VectorXd& theta) { return objective(theta).value; };
  }
  const search_result found = search(task, starts);
  const Eigen::VectorXd& theta = found.best.theta;
  const bool is_held = found.best.is_held;

  fit_summary summary;
  const curvature bend(found.best.hessian, found.best.free);
  const Eigen::VectorXd errors = has_data && !is_held
                                     ? bend.standard_errors(detail::scores(loss, measure, theta))
                                     : Eigen::VectorXd(Eigen::VectorXd::Zero(theta.size()));
  const auto at_start = trajectory_losses(held_out_loss, starts.front().theta);
  const auto at_end = trajectory_losses(held_out_loss, theta);
  summary.family = family.name;
  summary.system = data.system;
  summary.reference = data.reference;
  summary.ensemble = data.ensemble;
  summary.coordinates = to_string(options.coordinates);
  summary.loss_name = options.loss.description();
  summary.is_of_data = has_data;
  summary.derivatives = derivative_source<S>();
  summary.step = data.step;
  summary.seed = data.seed;
  summary.held_out_seed = held_out.seed;
  summary.held_out_is_new = !detail::begin_alike(data, held_out);
  summary.guard = guard.description();
  summary.coordinates_used = measure.residuals();
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const bool is_free =
        !is_held && std::find(found.best.free.begin(), found.best.free.end(), k) != found.best.free.end();
    summary.parameters.push_back(
        {family.parameter_names[static_cast<std::size_t>(k)], theta[k], is_free ? errors[k] : 0.0, is_free});
  }
  summary.loss = found.best.loss;
  summary.held_out_loss = tree_sum(at_end);
  summary.held_out_start_loss = tree_sum(at_start);
  summary.held_out_noise = detail::noise_of_difference(at_end, at_start);
  const loss_type one_step(family, system, held_out, measure, {.threads = options.threads});
  summary.one_step_error = std::sqrt(loss_value(one_step, theta));
  summary.trajectory_error = std::sqrt(loss_value(judge, theta));
  summary.samples = data.pairs();
  summary.trajectories = data.trajectories();
  summary.held_out_samples = held_out.pairs();
  if (!is_held) {  // where it is, no minimum is near
    summary.condition = bend.condition();
    for (const auto& flat : bend.flat_directions()) {
      summary.flat_directions.emplace_back(flat.begin(), flat.end());
    }
  }
  summary.dropped = measure.dropped();
  summary.starts_tried = found.tried;
  summary.from = found.best.from;
  summary.is_in_valley = found.best.in_valley;
  summary.is_held_by_guard = is_held;
  if (found.unguarded) {
    summary.unguarded =
        guard.objection(family.letters, family.coefficients(found.unguarded->theta), data.step);
  }
  summary.reference_checked = !data.finer.empty();
  if (summary.reference_checked) summary.reference_error = detail::error_of_reference(data, measure);
  summary.iterations = found.best.iterations;
  summary.data_seconds = data.seconds + held_out.seconds;
  summary.learning_evaluations = data.evaluations + held_out.evaluations + loss.evaluations() +
                                 held_out_loss.evaluations() + one_step.evaluations() + judge.evaluations();
  const auto coefficients = family.coefficients(theta);
  const std::string instability = guard.objection(family.letters, coefficients, data.step);
  if (instability.empty()) {
    for (const auto& [low, high] : guard.gaps(family.letters, coefficients, data.step)) {
      summary.gaps.push_back({low, high});
    }
  }
  summary.reason =
      detail::objection(summary, found.best.converged || found.best.in_valley || is_held, instability);
  summary.usable = summary.reason.empty();
  summary.fit_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return {theta, summary};
}

/// The same for a family as a type, whose method is one too.
template <Family F, SeparableSystem S, Scalar R = scalar_of_passes<S>>
learned<F> learn(const F& family, const S& system, const flow_map_data<S::dimension>& data,
                 const flow_map_data<S::dimension>& held_out, const learn_options<F>& options = {}) {
  require_suited<F, S>();
  fit_options its{.coordinates = options.coordinates,
                  .loss = options.loss,
                  .random_starts = options.random_starts,
                  .fixed = {options.fixed.begin(), options.fixed.end()},
                  .guarded = options.guarded,
                  .seed = options.seed,
                  .max_iterations = options.max_iterations,
                  .threads = options.threads};
  const run_time_family as_data(family);
  its.start = column_of(options.start);
  if (options.classical_starts) {
    its.further_starts.assign(as_data.starts.begin() + 1, as_data.starts.end());
  }
  const auto [theta, summary] = learn<S, R>(as_data, system, data, held_out, its);
  const member<F> found(array_of<parameters_of<F>{}.size()>(theta), family);
  return {tuned_method<F>(found, data.step, data.system), summary};
}

}  // namespace nysalt
