// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace nysalt {

namespace {

/// An orthonormal basis of v, A v, A^2 v, ..., in which the symmetric A is tridiagonal.
class krylov_space {
 public:
  explicit krylov_space(const Eigen::VectorXd& start) : next_(start.normalized()) {}

  /// By one product. Orthogonal to all directions before it, twice: once leaves rounding.
  void extend(const symmetric_map& multiply) {
    if (!basis_.empty()) beside_.push_back(rest_);
    basis_.push_back(next_);
    next_ = multiply(basis_.back());
    diagonal_.push_back(basis_.back().dot(next_));
    for (int pass = 0; pass < 2; ++pass) {
      for (const auto& v : basis_) next_ -= v.dot(next_) * v;
    }
    rest_ = next_.norm();
    if (rest_ > 0.0) next_ /= rest_;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(basis_.size()); }
  bool is_finite() const { return std::isfinite(rest_) && std::isfinite(diagonal_.back()); }
  /// A leads no further: what is left is rounding.
  bool is_closed() const {
    double largest = 0.0;
    for (const double a : diagonal_) largest = std::max(largest, std::abs(a));
    for (const double b : beside_) largest = std::max(largest, b);
    return rest_ <= 1e-12 * largest;
  }

  /// An eigenvalue lies within |A v - value v| = residual of the value.
  struct ritz_pair {
    double value;
    double residual;
    Eigen::VectorXd in_basis;
  };
  /// The lowest and the highest.
  std::array<ritz_pair, 2> ends() const {
    const Eigen::Map<const Eigen::VectorXd> diagonal(diagonal_.data(), size());
    const Eigen::Map<const Eigen::VectorXd> beside(beside_.data(), size() - 1);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, beside);
    const auto pair = [&](Eigen::Index j) -> ritz_pair {
      const double last = solver.eigenvectors()(size() - 1, j);
      return {solver.eigenvalues()[j], rest_ * std::abs(last), solver.eigenvectors().col(j)};
    };
    return {pair(0), pair(size() - 1)};
  }
  Eigen::VectorXd direction(const ritz_pair& pair) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(next_.size());
    for (Eigen::Index i = 0; i < size(); ++i) sum += pair.in_basis[i] * basis_[static_cast<std::size_t>(i)];
    return sum;
  }

 private:
  std::vector<Eigen::VectorXd> basis_;
  std::vector<double> diagonal_;
  std::vector<double> beside_;
  Eigen::VectorXd next_;
  double rest_ = 0.0;
};

}  // namespace

spectrum_ends ends_of_spectrum(const symmetric_map& multiply, const Eigen::VectorXd& start,
                               double relative_error) {
  const Eigen::Index most = std::min<Eigen::Index>(start.size(), 100);
  const Eigen::Index least = std::min<Eigen::Index>(start.size(), 8);  // a start may know another eigenvalue
  krylov_space space(start);
  while (true) {
    space.extend(multiply);
    if (!space.is_finite()) break;
    const bool is_last = space.size() == most || space.is_closed();
    if (space.size() < least && !is_last) continue;
    const auto [low, high] = space.ends();
    const double size = std::max(std::abs(low.value), std::abs(high.value));
    const bool is_known = low.residual <= relative_error * size &&
                          high.residual <= relative_error * std::max(high.value, 0.01 * size);
    if (!is_known && !is_last) continue;
    return {low.value - low.residual, high.value + high.residual, space.direction(low), space.direction(high),
            static_cast<int>(space.size())};
  }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, start, start, static_cast<int>(space.size())};
}

}  // namespace nysalt

namespace nysalt::detail {

Eigen::MatrixXd factor_of(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  const Eigen::VectorXd& squares = solver.eigenvalues();
  constexpr double rounding = 1e-12;  // a coordinate that runs at constant speed has none
  if (squares.minCoeff() < -rounding * std::abs(squares.maxCoeff())) return {};
  return solver.eigenvectors() * squares.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

std::vector<double> frequencies_of(const Eigen::MatrixXd& stiffness) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness);
  std::vector<double> result;
  for (const double x : solver.eigenvalues()) result.push_back(std::sqrt(std::max(0.0, x)));
  return result;
}

}  // namespace nysalt::detail
