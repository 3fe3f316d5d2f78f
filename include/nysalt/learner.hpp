// SPDX-License-Identifier: BSL-1.0
// Fits a family to the flow map of a system at a step.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/learning/minimise.hpp"
#include "nysalt/learning/objection.hpp"
#include "nysalt/losses/one_step.hpp"
#include "nysalt/method.hpp"
#include "nysalt/tree_sum.hpp"

namespace nysalt {

template <Family F>
struct learn_options {
  nysalt::coordinates coordinates = nysalt::coordinates::qp;
  parameters_of<F> start = F::start();
  std::array<std::optional<double>, static_cast<std::size_t>(F::parameters)> fixed{};
  int max_iterations = 200;
  int threads = 1;  // changes no bit of what is learned
};

template <Family F>
struct learned {
  tuned_method<F> method;
  fit_summary summary;
};

namespace detail {

/// Within the open ranges: beyond them the coefficients are not defined.
template <Family F>
bool is_defined(const Eigen::VectorXd& theta) {
  const auto ranges = F::ranges();
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (ranges[k].open && !ranges[k].contains(theta[static_cast<Eigen::Index>(k)])) return false;
  }
  return true;
}

/// What each trajectory adds to the gradient of the loss, by its residuals and by its part in the weights:
/// these are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out larger by some part
/// counts less by that part. Without this the standard errors are two to three times too small.
template <class Loss, int N>
std::vector<Eigen::VectorXd> scores(const Loss& loss, const metric<N>& measure, const theta_of<Loss>& theta) {
  const auto by_trajectory = coordinate_gradients(loss, theta);
  const Eigen::MatrixXd sum = tree_sum(by_trajectory);
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      result[m] -= sum.col(k) * measure.weight_deviations()(k, static_cast<Eigen::Index>(m));
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

}  // namespace detail

/// theta that minimises the one-step loss over `data` [li_lu_tao_ye_2023, section 3.1], judged on
/// `held_out`, which should come from another seed. Bounds that may be attained are left aside by the
/// search; where it ends beyond one, that parameter is held there and the others are fitted again.
///
/// Throws std::invalid_argument if the data are of another system, of two steps or not finite, or if the
/// coordinates, the start, a fixed value, max_iterations or threads cannot be. A fit that cannot be trusted
/// is returned with usable = false. Cost: some 20 to 80 passes over the data, each a plain step with
/// derivatives a pair; R carries the pairs, and changes no bit. Memory: another copy of the data.
template <Family F, SeparableSystem S, Scalar R = scalar_of_passes<F, S>>
learned<F> learn(const F& family, const S& system, const flow_map_data<S::dimension>& data,
                 const flow_map_data<S::dimension>& held_out, const learn_options<F>& options = {}) {
  const auto began = std::chrono::steady_clock::now();
  require_suited<F, S>();
  require_valid(data, system);
  require_valid(held_out, system);
  if (options.max_iterations < 0) {
    throw std::invalid_argument(
        fmt::format("learn: max_iterations must not be negative, got {}", options.max_iterations));
  }
  if (held_out.step != data.step) {
    throw std::invalid_argument(
        fmt::format("learn: the data have the step {}, the held-out data {}", data.step, held_out.step));
  }
  auto theta = options.start;
  for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = options.fixed[k].value_or(theta[k]);
  require_in_range<F>(theta);

  const metric<S::dimension> measure(system, data, options.coordinates);
  const one_step<F, S, R> loss(system, data, measure, options.threads, family);
  const one_step<F, S, R> held_out_loss(system, held_out, measure, options.threads, family);
  const auto held_out_at_start = trajectory_losses(held_out_loss, theta);

  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < theta.size(); ++k) {
    if (!options.fixed[k]) free.push_back(static_cast<Eigen::Index>(k));
  }
  fit_summary fit;
  bool converged = false;
  Eigen::MatrixXd hessian;
  for (bool inside = false; !inside;) {
    const auto found =
        minimise(objective_of(loss), detail::is_defined<F>, column_of(theta), free, options.max_iterations);
    theta = array_of<parameters_of<F>{}.size()>(found.theta);
    converged = found.converged;
    fit.loss = found.loss;
    hessian = found.hessian;
    fit.iterations += found.iterations;
    inside = 0 == std::erase_if(free, [&](Eigen::Index index) {
               constexpr double met =
                   1e-12;  // a bound that is met to rounding is met: exact recovery of Verlet
               const auto k = static_cast<std::size_t>(index);
               const auto range = F::ranges()[k];
               if (range.open || (range.low + met < theta[k] && theta[k] < range.high - met)) return false;
               theta[k] = theta[k] - range.low < range.high - theta[k] ? range.low : range.high;
               return true;
             });
  }

  const curvature bend(hessian, free);
  const Eigen::VectorXd errors = bend.standard_errors(detail::scores(loss, measure, theta));
  fit.family = F::name;
  fit.system = data.system;
  fit.reference = data.reference;
  fit.ensemble = data.ensemble;
  fit.coordinates = to_string(options.coordinates);
  fit.derivatives = derivative_source<S>();
  fit.step = data.step;
  fit.seed = data.seed;
  fit.held_out_seed = held_out.seed;
  fit.held_out_is_new = !detail::begin_alike(data, held_out);
  fit.stability_checked = HasFrequencyBands<S>;
  fit.coordinates_used = measure.residuals();
  for (std::size_t k = 0; k < theta.size(); ++k) {
    const auto index = static_cast<Eigen::Index>(k);
    const bool is_free = std::find(free.begin(), free.end(), index) != free.end();
    fit.parameters.push_back(
        {std::string(F::parameter_names[k]), theta[k], is_free ? errors[index] : 0.0, is_free});
  }
  const auto held_out_at_end = trajectory_losses(held_out_loss, theta);
  fit.held_out_loss = tree_sum(held_out_at_end);
  fit.held_out_start_loss = tree_sum(held_out_at_start);
  fit.held_out_noise = detail::noise_of_difference(held_out_at_end, held_out_at_start);
  fit.samples = data.pairs();
  fit.trajectories = data.trajectories();
  fit.held_out_samples = held_out.pairs();
  fit.condition = bend.condition();
  for (const auto& flat : bend.flat_directions()) fit.flat_directions.emplace_back(flat.begin(), flat.end());
  fit.dropped = measure.dropped();
  fit.one_step_error = std::sqrt(fit.loss);
  fit.reference_checked = !data.finer.empty();
  if (fit.reference_checked) fit.reference_error = detail::error_of_reference(data, measure);
  fit.data_seconds = data.seconds + held_out.seconds;
  fit.learning_evaluations =
      data.evaluations + held_out.evaluations + loss.evaluations() + held_out_loss.evaluations();
  fit.reason = detail::objection(system, fit, member<F>(theta, family), converged);
  fit.usable = fit.reason.empty();
  fit.fit_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return {tuned_method<F>(member<F>(theta, family), data.step, data.system), fit};
}

}  // namespace nysalt
