// SPDX-License-Identifier: BSL-1.0
// A loss as the sum of squares that it is, and what the learner asks of a loss over data.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// Sums of residuals r with the Jacobian J by theta: the loss r^T r, half its gradient J^T r, and J^T J,
/// which is half of Gauss-Newton's Hessian.
struct squares {
  double value = 0.0;             ///< r^T r
  Eigen::VectorXd half_gradient;  ///< J^T r
  Eigen::MatrixXd normal_matrix;  ///< J^T J

  Eigen::VectorXd gradient() const;  ///< gradient of the loss: 2 J^T r
  /// Whether all numbers are.
  bool is_finite() const;
};

/// A loss as a function of theta only: a search need not know what is behind it.
using objective = std::function<squares(const Eigen::VectorXd& theta)>;

/// A condition on theta: that coefficients are defined there, or that a guard admits the member.
using theta_condition = std::function<bool(const Eigen::VectorXd& theta)>;

/// A loss over data: a sum over trajectories of squares of residuals. after_steps is one; a loss with a pass
/// of another kind over the data is another class. Where ranks share the data, each rank has its own
/// trajectories, and the functions of theta are collective.
class loss_on_data {
 public:
  virtual ~loss_on_data() = default;

  /// The loss and its derivatives, of all ranks. Cost: one pass over the data with derivatives.
  virtual squares at(const Eigen::VectorXd& theta) const = 0;
  /// The contribution of each trajectory of this rank to the loss. Cost: one pass over the data.
  virtual std::vector<double> by_trajectory(const Eigen::VectorXd& theta) const = 0;
  /// The contribution of each residual to the loss, of all ranks. Cost: one pass over the data.
  virtual Eigen::VectorXd by_residual(const Eigen::VectorXd& theta) const = 0;
  /// The contribution of each trajectory of this rank to the gradient of the loss: a column for each
  /// residual. Cost: one pass over the data with derivatives.
  virtual std::vector<Eigen::MatrixXd> gradients(const Eigen::VectorXd& theta) const = 0;
  virtual std::size_t residuals() const = 0;  ///< number of residuals of a window, at all of its times
  /// Whether the weights of the residuals come from a metric, which estimates them from the data.
  virtual bool has_estimated_weights() const = 0;
  /// The same loss, over the same data, of another family. The letters O of both words are at the same
  /// places.
  virtual std::unique_ptr<const loss_on_data> of_family(const nysalt::family& family) const = 0;
  virtual const shard& share() const = 0;        ///< distribution of the trajectories over ranks
  virtual std::int64_t evaluations() const = 0;  ///< force evaluations of all passes so far at this rank

  /// The loss, of all ranks. Cost: one pass over the data.
  double value(const Eigen::VectorXd& theta) const { return share().sum(by_trajectory(theta)); }
};

namespace detail {

/// A loss over data as a function of theta only. Refers to the loss.
inline objective objective_of(const loss_on_data& loss) {
  return [&loss](const Eigen::VectorXd& theta) { return loss.at(theta); };
}

}  // namespace detail

}  // namespace nysalt
