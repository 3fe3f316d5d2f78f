// SPDX-License-Identifier: BSL-1.0
// A loss around a point: its value, gradient and Hessian, and the uncertainty of a minimum.
#pragma once

#include <Eigen/Eigenvalues>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "nysalt/scalars/dual.hpp"
#include "nysalt/tree_sum.hpp"

namespace nysalt {

template <class Loss>
inline constexpr int parameters_v = Loss::family::parameters;
template <class Loss>
using theta_of = std::array<double, static_cast<std::size_t>(parameters_v<Loss>)>;

/// What each block adds to the loss.
template <class Loss>
std::vector<double> block_losses(const Loss& loss, const theta_of<Loss>& theta) {
  std::vector<double> result;
  std::vector<double> r;
  for (std::size_t block = 0; block < loss.blocks(); ++block) {
    r.resize(loss.residuals(block));
    loss.template evaluate<double>(block, theta, r.data());
    double sum = 0.0;
    for (const double x : r) sum += x * x;
    result.push_back(sum);
  }
  return result;
}
template <class Loss>
double loss_value(const Loss& loss, const theta_of<Loss>& theta) {
  return tree_sum(block_losses(loss, theta));
}

/// Calls visit(block, i, the exact gradient of the square of residual i), in order.
/// Cost: one pass over duals.
template <class Loss>
void visit_gradients(const Loss& loss, const theta_of<Loss>& theta, const auto& visit) {
  constexpr std::size_t count = static_cast<std::size_t>(parameters_v<Loss>);
  using D = dual<double, parameters_v<Loss>>;
  std::array<D, count> lifted;
  for (std::size_t k = 0; k < count; ++k) lifted[k] = D::variable(theta[k], static_cast<int>(k));
  Eigen::VectorXd gradient(parameters_v<Loss>);
  std::vector<D> r;
  for (std::size_t block = 0; block < loss.blocks(); ++block) {
    r.resize(loss.residuals(block));
    loss.template evaluate<D>(block, lifted, r.data());
    for (std::size_t i = 0; i < r.size(); ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        gradient[static_cast<Eigen::Index>(k)] = 2.0 * r[i].value * r[i].derivative[k];
      }
      visit(block, i, gradient);
    }
  }
}

/// What each block adds to the gradient of the loss.
template <class Loss>
std::vector<Eigen::VectorXd> block_gradients(const Loss& loss, const theta_of<Loss>& theta) {
  std::vector<Eigen::VectorXd> result(loss.blocks(), Eigen::VectorXd::Zero(parameters_v<Loss>));
  visit_gradients(loss, theta, [&](std::size_t block, std::size_t, const Eigen::VectorXd& gradient) {
    result[block] += gradient;
  });
  return result;
}
template <class Loss>
Eigen::VectorXd loss_gradient(const Loss& loss, const theta_of<Loss>& theta) {
  return tree_sum(block_gradients(loss, theta));
}

/// What each coordinate of the metric adds to the gradient of the loss: a column each.
template <class Loss>
Eigen::MatrixXd coordinate_gradients(const Loss& loss, const theta_of<Loss>& theta,
                                     Eigen::Index coordinates) {
  std::vector<Eigen::MatrixXd> of_block(loss.blocks(),
                                        Eigen::MatrixXd::Zero(parameters_v<Loss>, coordinates));
  visit_gradients(loss, theta, [&](std::size_t block, std::size_t i, const Eigen::VectorXd& gradient) {
    of_block[block].col(static_cast<Eigen::Index>(i) % coordinates) += gradient;
  });
  return tree_sum(of_block);
}

/// The full Hessian (not Gauss-Newton's: residuals do not vanish at the minimum) by central differences of
/// the exact gradient. Its relative error is about 1e-8: s^2 of the step, and eps/s of the gradient.
template <class Loss>
Eigen::MatrixXd hessian(const Loss& loss, const theta_of<Loss>& theta) {
  constexpr double s = 1e-4;  // parameters are of order one
  Eigen::MatrixXd result(parameters_v<Loss>, parameters_v<Loss>);
  for (std::size_t k = 0; k < theta.size(); ++k) {
    auto ahead = theta;
    auto behind = theta;
    ahead[k] += s;
    behind[k] -= s;
    result.col(static_cast<Eigen::Index>(k)) =
        (loss_gradient(loss, ahead) - loss_gradient(loss, behind)) / (ahead[k] - behind[k]);
  }
  return 0.5 * (result + result.transpose());
}

/// A Hessian restricted to the free parameters, in its eigenvectors.
class curvature {
 public:
  curvature(const Eigen::MatrixXd& hessian, std::vector<Eigen::Index> free)
      : size_(hessian.rows()), free_(std::move(free)) {
    if (!free_.empty()) solver_.compute(hessian(free_, free_));
  }

  /// Directions along which the loss does not rise beyond the error of the Hessian, in all parameters.
  std::vector<Eigen::VectorXd> flat_directions() const {
    std::vector<Eigen::VectorXd> result;
    for (Eigen::Index k = 0; k < count(); ++k) {
      if (is_flat(k)) result.push_back(direction(k));
    }
    return result;
  }
  /// Largest over smallest curvature of the directions that are not flat.
  double condition() const {
    for (Eigen::Index k = 0; k < count(); ++k) {
      if (!is_flat(k)) return largest() / solver_.eigenvalues()[k];
    }
    return 1.0;
  }
  bool is_minimum() const { return count() == 0 || solver_.eigenvalues()[0] > -flat_below * largest(); }

  /// H^+ v: the inverse on what is free and not flat.
  Eigen::VectorXd solve(const Eigen::VectorXd& v) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
    for (Eigen::Index k = 0; k < count(); ++k) {
      if (!is_flat(k)) result += direction(k) * (direction(k).dot(v) / solver_.eigenvalues()[k]);
    }
    return result;
  }

  /// Sandwich covariance of the minimum [white_1982, theorem 3.2], clustered by block:
  /// H^+ (sum_b g_b g_b^T) H^+ B/(B - 1), where g_b is what block b adds to the gradient, by its residuals
  /// and by its part in the weights. It holds for a misspecified model, as a learned map is one.
  /// NaN with a single block; infinite along flat directions.
  Eigen::VectorXd standard_errors(const std::vector<Eigen::VectorXd>& scores) const {
    const auto blocks = static_cast<double>(scores.size());
    std::vector<Eigen::VectorXd> squares;
    for (const auto& score : scores) squares.push_back(solve(score).cwiseAbs2());
    Eigen::VectorXd result = (tree_sum(squares) * (blocks / (blocks - 1.0))).cwiseSqrt();
    if (blocks < 2.0) result.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const auto& flat : flat_directions()) {
      for (Eigen::Index i = 0; i < size_; ++i) {
        if (std::abs(flat[i]) > 1e-6) result[i] = std::numeric_limits<double>::infinity();
      }
    }
    return result;
  }

 private:
  static constexpr double flat_below = 1e-8;  // the relative error of the Hessian

  Eigen::Index count() const { return static_cast<Eigen::Index>(free_.size()); }
  double largest() const { return solver_.eigenvalues()[count() - 1]; }
  bool is_flat(Eigen::Index k) const { return !(solver_.eigenvalues()[k] > flat_below * largest()); }
  Eigen::VectorXd direction(Eigen::Index k) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
    result(free_) = solver_.eigenvectors().col(k);
    return result;
  }

  Eigen::Index size_;
  std::vector<Eigen::Index> free_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver_;  // eigenvalues rise
};

}  // namespace nysalt
