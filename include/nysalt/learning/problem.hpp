// SPDX-License-Identifier: BSL-1.0
// All that a search must know of a system, its data and a family; no type of any of them is left.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/learning/curvature.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/learning/require_valid.hpp"
#include "nysalt/learning/some_states.hpp"
#include "nysalt/learning/squares.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/stationary_covariance.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt {

/// How to search. What is empty is the family's own.
struct fit_options {
  nysalt::coordinates coordinates = nysalt::coordinates::qp;  ///< in which the error counts
  loss_choice loss{};                                         ///< what is minimised
  std::optional<Eigen::VectorXd> start{};                     ///< instead of the family's own starts
  std::vector<named_parameters> further_starts{};  ///< beside them, such as the optimum at a smaller step
  int random_starts = 0;                           ///< beside all these, normal around the first
  std::vector<std::optional<double>> fixed{};      ///< a value for each parameter that is not to be learned
  bool guarded = true;       ///< false: an unstable optimum is found, and said not to be usable
  bool check_force = true;   ///< before learn() begins, as what is learned from a wrong force is wrong
  std::uint64_t seed = 1;    ///< of the random starts
  int max_iterations = 200;  ///< of the search from each start
  int threads = 1;           ///< changes no bit of what is learned
};

/// What learn() makes of system and data, and solve() of this. Refers to the system. Where ranks share the
/// data each has its own part, and the functions are collective: all ranks search together, and find the
/// same.
struct learning_problem {
  run_time_family family;                      ///< what is fitted
  fit_options options;                         ///< as they were given
  double step;                                 ///< h of the data
  objective loss;                              ///< over the data; not asked where there is a law
  std::optional<stationary_covariance> law{};  ///< the loss that asks no data
  /// What each trajectory adds to the gradient of `loss`, its part in the weights included.
  std::function<trajectory_scores(const Eigen::VectorXd&)> scores;
  shard held_out;  ///< which held-out trajectories this rank has
  /// What each held-out trajectory of this rank adds to the loss.
  std::function<std::vector<double>(const Eigen::VectorXd&)> held_out_losses;
  std::function<double(const Eigen::VectorXd&)> one_step_loss;  ///< mean over held-out pairs
  std::function<double(const Eigen::VectorXd&)> loss_at_end;    ///< at the ends of held-out trajectories
  std::function<std::int64_t()> evaluations;  ///< of the force by all ranks so far, data included
  stability_guard guard;                      ///< knows the frequencies of the system
  fit_summary facts;                          ///< what is known before a search
};

namespace detail {

inline bool rotates(const run_time_word& word) { return has_rotation(word) || word.reads == field::soft; }

/// What each trajectory adds to the gradient of the loss, by its residuals and by its part in the weights:
/// these are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out larger by some part
/// counts less by that part. Without this the standard errors are two to three times too small.
template <class Loss, int N>
trajectory_scores scores(const Loss& loss, const metric<N>& measure, bool of_energy,
                         const Eigen::VectorXd& theta) {
  const auto by_trajectory = residual_gradients(loss, theta);
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(loss.parameters(), static_cast<Eigen::Index>(loss.residuals()));
  const Eigen::MatrixXd sum = loss.share().sum(by_trajectory, zero);
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      if (!of_energy) result[m] -= sum.col(k) * measure.weight_deviations()(k, static_cast<Eigen::Index>(m));
    }
  }
  return {std::move(result), loss.share()};
}

/// Whether the first trajectory, which rank 0 has, is the same. In a bath other noise makes another of the
/// same start.
template <int N>
bool begin_alike(const flow_map_data<N>& a, const flow_map_data<N>& b) {
  const communicator& ranks = a.share().ranks();
  bool result = false;
  if (ranks.is_first()) {
    const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
    result = a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
  }
  broadcast(ranks, result);
  return result;
}

/// The root mean square error of the reference, where it was checked.
template <int N>
double error_of_reference(const flow_map_data<N>& data, const metric<N>& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    double& of_trajectory = squares[data.trajectory_of(pair)];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  const auto checks = data.share().ranks().total(std::ssize(data.finer));
  return std::sqrt(data.share().sum(squares) / static_cast<double>(checks));
}

/// The number of steps of the shortest trajectory.
template <int N>
int shortest_of(const flow_map_data<N>& data) {
  std::size_t least = data.all_pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  const auto of_all = data.share().ranks().least(static_cast<std::int64_t>(least));
  return static_cast<int>(std::max<std::int64_t>(of_all, 1));
}

}  // namespace detail

/// The problem of fitting the family's word to the data. Refers to the system. Throws what learn() does.
template <SeparableSystem S, Scalar R = scalar_of_passes<S>>
learning_problem make_learning_problem(const run_time_family& family, const S& system,
                                       const flow_map_data<S::dimension>& data,
                                       const flow_map_data<S::dimension>& held_out,
                                       const fit_options& options) {
  require_valid(data, system);
  require_valid(held_out, system);
  require_served<S, double>(family.letters, system);
  require_served<S, dual<R, directions_at_a_time>>(family.letters, system);
  if (held_out.step != data.step) {
    throw std::invalid_argument(
        fmt::format("learn: the data have the step {}, the held-out data {}", data.step, held_out.step));
  }
  if (&held_out.share().ranks() != &data.share().ranks()) {
    throw std::invalid_argument("learn: the data and the held-out data must be shared by the same ranks");
  }
  using loss_type = after_steps<S, R>;
  using metric_type = metric<S::dimension>;
  const bool has_data = options.loss.of != loss_choice::kind::covariance;
  const communicator& ranks = data.share().ranks();
  const auto measure = std::make_shared<const metric_type>(system, data, options.coordinates);
  const auto loss_over = [&](const auto& pairs, const after_steps_options& how) {
    return std::make_shared<const loss_type>(family, system, pairs, *measure, how);
  };
  const after_steps_options how{.steps = options.loss.steps,
                                .energy = options.loss.of == loss_choice::kind::energy,
                                .overlap = true,
                                .threads = options.threads};
  const auto loss = loss_over(data, how);
  const auto held = loss_over(held_out, how);
  const auto one_step = loss_over(held_out, {.threads = options.threads});
  const auto at_end = loss_over(
      held_out, {.steps = detail::shortest_of(held_out), .overlap = false, .threads = options.threads});

  learning_problem problem{
      .family = family,
      .options = options,
      .step = data.step,
      .loss = [loss](const Eigen::VectorXd& theta) { return squares_at(*loss, theta); },
      .scores =
          [loss, measure, of_energy = how.energy](const Eigen::VectorXd& theta) {
            return detail::scores(*loss, *measure, of_energy, theta);
          },
      .held_out = held_out.share(),
      .held_out_losses = [held](const Eigen::VectorXd& theta) { return trajectory_losses(*held, theta); },
      .one_step_loss = [one_step,
                        measure](const Eigen::VectorXd& theta) { return loss_value(*one_step, theta); },
      .loss_at_end = [at_end](const Eigen::VectorXd& theta) { return loss_value(*at_end, theta); },
      .evaluations =
          [=, &ranks, of_data = data.evaluations + held_out.evaluations] {
            return of_data + ranks.total(loss->evaluations() + held->evaluations() + one_step->evaluations() +
                                         at_end->evaluations());
          },
      .guard = stability_guard(system, some_states(data, size(system)), detail::rotates(family.letters)),
      .facts = {}};
  if (!has_data) {
    if constexpr (HasBath<S> && HasModes<S>) {
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
  facts.loss_name = options.loss.description();
  facts.is_of_data = has_data;
  facts.derivatives = derivative_source<S>();
  facts.step = data.step;
  facts.seed = data.seed;
  facts.held_out_seed = held_out.seed;
  facts.held_out_is_new = !detail::begin_alike(data, held_out);
  facts.guard = problem.guard.description();
  facts.coordinates_used = measure->residuals();
  facts.dropped = measure->dropped();
  facts.samples = data.all_pairs();
  facts.trajectories = static_cast<std::size_t>(data.share().total());
  facts.held_out_samples = held_out.all_pairs();
  facts.reference_checked = ranks.total(std::ssize(data.finer)) > 0;
  if (facts.reference_checked) facts.reference_error = detail::error_of_reference(data, *measure);
  facts.data_seconds = data.seconds + held_out.seconds;
  return problem;
}

}  // namespace nysalt
