// SPDX-License-Identifier: BSL-1.0
// The Hessian of a loss, and the uncertainty of a minimum that follows from it.
#pragma once

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "nysalt/learning/squares.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// What each trajectory, or other block of data, adds to the gradient of a loss: those of this rank.
struct trajectory_scores {
  std::vector<Eigen::VectorXd> of_each;  ///< one gradient for each block of this rank
  shard share;                           ///< which blocks this rank has

  /// All blocks are here.
  trajectory_scores(std::vector<Eigen::VectorXd> all) : of_each(std::move(all)), share(std::ssize(of_each)) {}
  /// This rank's blocks of those that ranks share.
  trajectory_scores(std::vector<Eigen::VectorXd> ours, const shard& whose)
      : of_each(std::move(ours)), share(whose) {}

  double blocks() const { return static_cast<double>(share.total()); }  ///< B, of all ranks
};

namespace detail {

/// By how much Gauss-Newton's curvatures differ at two points, relative to their sum; infinite where one is
/// not finite. Each is of one parameter, so that no unit matters.
inline double relative_difference(const squares& a, const squares& b) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < a.normal_matrix.rows(); ++k) {
    const double sum = a.normal_matrix(k, k) + b.normal_matrix(k, k);
    const double difference = std::abs(a.normal_matrix(k, k) - b.normal_matrix(k, k));
    if (sum > 0.0) largest = std::max(largest, difference / sum);
  }
  return a.is_finite() && b.is_finite() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace detail

/// The full Hessian (not Gauss-Newton's: residuals do not vanish at the minimum) by central differences of
/// the exact gradient. Its relative error is about 1e-8: some hundred s^2 of the step, and eps/s of the
/// gradient. The step is 1e-5 of a parameter beyond 1 and else of 1; of one in other units, where
/// Gauss-Newton's curvatures change by more than 1e-3 over it, it is shorter, until they do not. Cost: two
/// passes with derivatives for each parameter, as much as one with exact second derivatives, which a black
/// box has not; two more for each step that is too long.
inline Eigen::MatrixXd hessian(const objective& loss, const Eigen::VectorXd& theta) {
  constexpr double much = 1e-3;    // a step s is then 1e-3 of the length over which the loss changes its form
  constexpr double wanted = 1e-4;  // as 1e-5 is of a coefficient, which is of order one
  constexpr int most = 20;         // a step 1e-20 times as long is lost in theta
  Eigen::MatrixXd result(theta.size(), theta.size());
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    double s = 1e-5 * std::max(1.0, std::abs(theta[k]));
    for (int n = 0; n < most; ++n) {
      Eigen::VectorXd ahead = theta;
      Eigen::VectorXd behind = theta;
      ahead[k] += s;
      behind[k] -= s;
      const squares there = loss(ahead);
      const squares back = loss(behind);
      result.col(k) = (there.gradient() - back.gradient()) / (ahead[k] - behind[k]);
      const double changes = detail::relative_difference(there, back);
      if (changes <= much) break;
      s *= std::max(0.01, wanted / changes);
    }
  }
  return 0.5 * (result + result.transpose());
}

/// The same of a loss over data.
template <class Loss>
  requires requires(const Loss& loss) { loss.residuals(); }
Eigen::MatrixXd hessian(const Loss& loss, const Eigen::VectorXd& theta) {
  return hessian(objective_of(loss), theta);
}

/// A Hessian restricted to the free parameters, in its eigenvectors.
class curvature {
 public:
  /// The Hessian is by all parameters; `free` numbers those that are free.
  curvature(const Eigen::MatrixXd& hessian, std::vector<Eigen::Index> free)
      : size_(hessian.rows()), free_(std::move(free)) {
    if (free_.empty()) return;
    const Eigen::MatrixXd of_free = hessian(free_, free_);
    solver_.compute(of_free);
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
  /// Whether the loss falls along no direction, but for the error of the Hessian.
  bool is_minimum() const { return count() == 0 || solver_.eigenvalues()[0] > -flat_below * largest(); }

  /// H^+ v, the inverse of the Hessian on what is free and not flat.
  Eigen::VectorXd solve(const Eigen::VectorXd& v) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
    for (Eigen::Index k = 0; k < count(); ++k) {
      if (!is_flat(k)) result += direction(k) * (direction(k).dot(v) / solver_.eigenvalues()[k]);
    }
    return result;
  }

  /// What the uncertainty of the minimum adds to the loss on new data, in the mean: the loss L is least at
  /// theta*, and with H = L'' there and C the covariance of the minimum theta,
  ///   E L(theta) - L(theta*) = E (theta - theta*)^T H (theta - theta*)/2 = tr(H C)/2.
  /// C is that of standard_errors(), so that H C has one H^+ less: B/(B - 1) sum_b g_b^T H^+ g_b/2. Along a
  /// flat direction C has no bound, and H nothing to add: it is left out. NaN with a single block.
  double expected_excess(const trajectory_scores& scores) const {
    const double blocks = scores.blocks();
    if (blocks < 2.0) return std::numeric_limits<double>::quiet_NaN();
    return scores.share.sum(excesses(scores)) * (blocks / (blocks - 1.0));
  }

  /// On how many blocks that, and with it the standard errors, rest: (sum_b e_b)^2/sum_b e_b^2, with
  /// e_b = g_b^T H^+ g_b. Of B blocks with normal gradients it is B P/(P + 2), P the number of parameters.
  double deciding_blocks(const trajectory_scores& scores) const {
    auto terms = excesses(scores);
    const double sum = scores.share.sum(terms);
    for (double& e : terms) e *= e;
    const double squares = scores.share.sum(terms);
    return squares > 0.0 ? sum * sum / squares : scores.blocks();
  }

  /// Sandwich covariance of the minimum [white_1982, theorem 3.2], clustered by block:
  /// H^+ (sum_b g_b g_b^T) H^+ B/(B - 1), where g_b is what block b adds to the gradient, by its residuals
  /// and by its part in the weights. It holds for a misspecified model, as a learned map is one.
  /// NaN with a single block; infinite along flat directions.
  Eigen::VectorXd standard_errors(const trajectory_scores& scores) const {
    const double blocks = scores.blocks();
    std::vector<Eigen::VectorXd> squares;
    for (const auto& score : scores.of_each) squares.push_back(solve(score).cwiseAbs2());
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size_);
    Eigen::VectorXd result = (scores.share.sum(squares, zero) * (blocks / (blocks - 1.0))).cwiseSqrt();
    if (blocks < 2.0) result.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const auto& flat : flat_directions()) {
      for (Eigen::Index i = 0; i < size_; ++i) {
        if (std::abs(flat[i]) > 1e-6) result[i] = std::numeric_limits<double>::infinity();
      }
    }
    return result;
  }

 private:
  std::vector<double> excesses(const trajectory_scores& scores) const {
    std::vector<double> result;
    for (const auto& score : scores.of_each) result.push_back(0.5 * score.dot(solve(score)));
    return result;
  }

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
