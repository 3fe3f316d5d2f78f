// SPDX-License-Identifier: BSL-1.0
// A loss around a point: its value, gradient and Hessian, and the uncertainty of a minimum.
#pragma once

#include <Eigen/Eigenvalues>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "nysalt/scalars/dual.hpp"

namespace nysalt {

template <class Loss>
inline constexpr int parameters_v = Loss::family::parameters;
template <class Loss>
using theta_of = std::array<double, static_cast<std::size_t>(parameters_v<Loss>)>;

template <class Loss>
double loss_value(const Loss& loss, const theta_of<Loss>& theta) {
  double sum = 0.0;
  std::vector<double> r;
  for (std::size_t block = 0; block < loss.blocks(); ++block) {
    r.resize(loss.residuals(block));
    loss.template evaluate<double>(block, theta, r.data());
    double of_block = 0.0;
    for (const double x : r) of_block += x * x;
    sum += of_block;
  }
  return sum;
}

/// The exact gradient, spread over columns: residual i of block b counts in column(b, i).
/// Cost: one pass over duals.
template <class Loss>
Eigen::MatrixXd gradients(const Loss& loss, const theta_of<Loss>& theta, std::size_t columns, auto&& column) {
  constexpr std::size_t count = static_cast<std::size_t>(parameters_v<Loss>);
  using D = dual<double, parameters_v<Loss>>;
  std::array<D, count> lifted;
  for (std::size_t k = 0; k < count; ++k) lifted[k] = D::variable(theta[k], static_cast<int>(k));
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(parameters_v<Loss>, static_cast<Eigen::Index>(columns));
  std::vector<D> r;
  for (std::size_t block = 0; block < loss.blocks(); ++block) {
    r.resize(loss.residuals(block));
    loss.template evaluate<D>(block, lifted, r.data());
    for (std::size_t i = 0; i < r.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(column(block, i));
      for (std::size_t k = 0; k < count; ++k) {
        result(static_cast<Eigen::Index>(k), j) += 2.0 * r[i].value * r[i].derivative[k];
      }
    }
  }
  return result;
}

/// One column a block: the gradient of the loss is their sum.
template <class Loss>
Eigen::MatrixXd block_gradients(const Loss& loss, const theta_of<Loss>& theta) {
  return gradients(loss, theta, loss.blocks(), [](std::size_t block, std::size_t) { return block; });
}

/// One column a coordinate of the metric: the same sum.
template <class Loss>
Eigen::MatrixXd coordinate_gradients(const Loss& loss, const theta_of<Loss>& theta, std::size_t coordinates) {
  return gradients(loss, theta, coordinates, [=](std::size_t, std::size_t i) { return i % coordinates; });
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
        (block_gradients(loss, ahead).rowwise().sum() - block_gradients(loss, behind).rowwise().sum()) /
        (ahead[k] - behind[k]);
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
  Eigen::VectorXd standard_errors(const Eigen::MatrixXd& scores) const {
    const auto blocks = static_cast<double>(scores.cols());
    Eigen::MatrixXd spread(size_, scores.cols());
    for (Eigen::Index b = 0; b < scores.cols(); ++b) spread.col(b) = solve(scores.col(b));
    Eigen::VectorXd result = (spread.rowwise().squaredNorm() * (blocks / (blocks - 1.0))).cwiseSqrt();
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
