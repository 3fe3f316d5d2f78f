// SPDX-License-Identifier: BSL-1.0
// The Hessian of a loss, and the uncertainty of a minimum that follows from it.

#include "curvature.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace nysalt {

namespace {

/// By how much Gauss-Newton's curvatures differ at two points, relative to their sum; infinite where one is
/// not finite. Each is of one parameter, so that no unit matters.
double relative_difference(const squares& a, const squares& b) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < a.normal_matrix.rows(); ++k) {
    const double sum = a.normal_matrix(k, k) + b.normal_matrix(k, k);
    const double difference = std::abs(a.normal_matrix(k, k) - b.normal_matrix(k, k));
    if (sum > 0.0) largest = std::max(largest, difference / sum);
  }
  return a.is_finite() && b.is_finite() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace

Eigen::MatrixXd hessian(const objective& loss, const Eigen::VectorXd& theta) {
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
      const double changes = relative_difference(there, back);
      if (changes <= much) break;
      s *= std::max(0.01, wanted / changes);
    }
  }
  return 0.5 * (result + result.transpose());
}

trajectory_scores scores_of(const loss_on_data& loss, const Eigen::VectorXd& theta,
                            const Eigen::MatrixXd& deviations) {
  const auto by_trajectory = loss.gradients(theta);
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(theta.size(), static_cast<Eigen::Index>(loss.residuals()));
  const Eigen::MatrixXd sum = loss.share().sum(by_trajectory, zero);
  std::vector<Eigen::VectorXd> result;
  for (std::size_t m = 0; m < by_trajectory.size(); ++m) {
    result.push_back(Eigen::VectorXd::Zero(sum.rows()));
    for (Eigen::Index k = 0; k < sum.cols(); ++k) {
      result[m] += by_trajectory[m].col(k);
      if (!loss.has_estimated_weights()) continue;
      result[m] -= sum.col(k) * deviations(k % deviations.rows(), static_cast<Eigen::Index>(m));
    }
  }
  return {std::move(result), loss.share()};
}

curvature::curvature(const Eigen::MatrixXd& hessian, std::vector<Eigen::Index> free)
    : size_(hessian.rows()), free_(std::move(free)) {
  if (free_.empty()) return;
  const Eigen::MatrixXd of_free = hessian(free_, free_);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(of_free);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
}

std::vector<Eigen::VectorXd> curvature::flat_directions() const {
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (is_flat(k)) result.push_back(direction(k));
  }
  return result;
}

double curvature::condition() const {
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (!is_flat(k)) return largest() / eigenvalues_[k];
  }
  return 1.0;
}

bool curvature::is_minimum() const { return count() == 0 || eigenvalues_[0] > -flat_below * largest(); }

Eigen::VectorXd curvature::solve(const Eigen::VectorXd& v) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
  for (Eigen::Index k = 0; k < count(); ++k) {
    if (!is_flat(k)) result += direction(k) * (direction(k).dot(v) / eigenvalues_[k]);
  }
  return result;
}

double curvature::expected_excess(const trajectory_scores& scores) const {
  const double blocks = scores.blocks();
  if (blocks < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return scores.share.sum(excesses(scores)) * (blocks / (blocks - 1.0));
}

double curvature::deciding_blocks(const trajectory_scores& scores) const {
  auto terms = excesses(scores);
  const double sum = scores.share.sum(terms);
  for (double& e : terms) e *= e;
  const double squares = scores.share.sum(terms);
  return squares > 0.0 ? sum * sum / squares : scores.blocks();
}

spread_of_minimum curvature::spread(const trajectory_scores& scores, const trajectory_scores& others) const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size_);
  const double blocks = scores.blocks();
  const double further = others.blocks();
  Eigen::VectorXd squares = zero;
  Eigen::VectorXd fourths = zero;
  const auto add = [&](const trajectory_scores& some, const Eigen::VectorXd& mean, double factor) {
    std::vector<Eigen::VectorXd> powers;
    for (const auto& score : some.of_each) powers.push_back((solve(score - mean) * factor).cwiseAbs2());
    squares += some.share.sum(powers, zero);
    for (auto& power : powers) power = power.cwiseAbs2().eval();
    fourths += some.share.sum(powers, zero);
  };
  add(scores, zero, 1.0);  // at the minimum they sum to zero
  double freedom = blocks - 1.0;
  if (further >= 2.0) {  // a score is of the mean over all of its data: B'/B of it is one among B
    add(others, others.share.sum(others.of_each, zero) / further, further / blocks);
    freedom += further - 1.0;
  }
  spread_of_minimum result{(squares * (blocks / freedom)).cwiseSqrt(), zero};
  for (Eigen::Index i = 0; i < size_; ++i) {
    result.deciding[i] = fourths[i] > 0.0 ? squares[i] * squares[i] / fourths[i] : freedom;
  }
  if (blocks < 2.0) result.standard_errors.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const auto& flat : flat_directions()) {
    for (Eigen::Index i = 0; i < size_; ++i) {
      if (std::abs(flat[i]) > 1e-6) result.standard_errors[i] = std::numeric_limits<double>::infinity();
    }
  }
  return result;
}

std::vector<double> curvature::excesses(const trajectory_scores& scores) const {
  std::vector<double> result;
  for (const auto& score : scores.of_each) result.push_back(0.5 * score.dot(solve(score)));
  return result;
}

double curvature::largest() const { return eigenvalues_[count() - 1]; }

bool curvature::is_flat(Eigen::Index k) const { return !(eigenvalues_[k] > flat_below * largest()); }

Eigen::VectorXd curvature::direction(Eigen::Index k) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
  result(free_) = eigenvectors_.col(k);
  return result;
}

}  // namespace nysalt
