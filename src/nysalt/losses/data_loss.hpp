// SPDX-License-Identifier: BSL-1.0
// A loss over data as what the learner asks of it: no type of it is left.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "nysalt/learning/curvature.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/window_error.hpp"

namespace nysalt::detail {

/// From what a loss over data is made.
struct loss_inputs {
  const run_time_family& family;
  const model& system;
  const flow_map_data& data;
  std::shared_ptr<const metric> measure;  // which the loss keeps
  after_steps_options how;
  bool in_lanes;  // whether windows are in lanes
};

/// Functions of theta; all are collective where ranks share the data.
struct data_loss {
  objective of_theta;
  /// With the deviations of the weights that these trajectories make; only if weights are estimated.
  std::function<trajectory_scores(const Eigen::VectorXd&, const Eigen::MatrixXd& deviations)> scores;
  std::function<std::vector<double>(const Eigen::VectorXd&)> by_trajectory;  // of those of this rank
  std::function<double(const Eigen::VectorXd&)> value;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> by_residual;  // the mean square of each
  std::function<std::int64_t()> evaluations;                           // of the force at this rank so far
  /// The same of a method, which has no parameters; by_trajectory() at the empty theta.
  std::function<std::vector<double>(const run_time_family& method)> by_trajectory_of;
};

/// The contribution of each trajectory to the gradient of the loss, by its residuals and by its part in the
/// weights: those of a metric are 1/Sigma, and Sigma is estimated, so that a coordinate whose Sigma comes out
/// larger by some part counts less by that part. Without this the standard errors are two to three times too
/// small.
template <class Loss>
trajectory_scores scores_of(const Loss& loss, const Eigen::VectorXd& theta,
                            const Eigen::MatrixXd& deviations) {
  const bool has_estimated_weights = loss.error().weight_deviations != nullptr;
  const auto by_trajectory = residual_gradients(loss, theta);
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(loss.parameters(), static_cast<Eigen::Index>(loss.residuals()));
  const Eigen::MatrixXd sum = loss.share().sum(by_trajectory, zero);
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      if (!has_estimated_weights) continue;
      result[m] -= sum.col(k) * deviations(k % deviations.rows(), static_cast<Eigen::Index>(m));
    }
  }
  return {std::move(result), loss.share()};
}

/// Of any loss that offers what after_steps does. Keeps the metric that it refers to.
template <class Loss>
data_loss without_type(const std::shared_ptr<const Loss>& loss, const std::shared_ptr<const metric>& kept) {
  return {
      .of_theta = [loss, kept](const Eigen::VectorXd& theta) { return squares_at(*loss, theta); },
      .scores = [loss, kept](
                    const Eigen::VectorXd& theta,
                    const Eigen::MatrixXd& deviations) { return scores_of(*loss, theta, deviations); },
      .by_trajectory = [loss, kept](const Eigen::VectorXd& theta) { return trajectory_losses(*loss, theta); },
      .value = [loss, kept](const Eigen::VectorXd& theta) { return loss_value(*loss, theta); },
      .by_residual = [loss, kept](const Eigen::VectorXd& theta) { return residual_squares(*loss, theta); },
      .evaluations = [loss] { return loss->evaluations(); },
      .by_trajectory_of =
          [loss, kept](const run_time_family& method) {
            return trajectory_losses(Loss(*loss, method), Eigen::VectorXd());
          },
  };
}

/// What losses() lists, each in the source of that name.
extern const loss_kind trajectory_loss, state_loss, energy_loss, acceptance_loss, gaussian_acceptance_loss,
    covariance_loss;

/// The mean over windows of the squares of these residuals.
data_loss after_steps_of(const loss_inputs& from, const window_error<lanes>& error);
data_loss after_steps_of(const loss_inputs& from, const window_error<double>& error);

/// That of the state's error.
data_loss of_states(const loss_inputs& from);

/// After how many steps energies of proposals are read.
std::vector<after_steps_options> stages_of_acceptance(int K, int shortest);

/// That of the energy's error. Throws std::invalid_argument if the energy of the system is not known.
data_loss of_energies(const loss_inputs& from);

}  // namespace nysalt::detail
