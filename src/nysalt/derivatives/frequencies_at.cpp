// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/frequencies_at.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

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
