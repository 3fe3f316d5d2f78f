// SPDX-License-Identifier: BSL-1.0

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

normal_modes detail::stiffness_modes(const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& inverse_masses,
                                     std::string_view who) {
  const Eigen::Index n = stiffness.rows();
  if (n == 0 || n != stiffness.cols()) {
    throw std::invalid_argument(
        sentence("{}: the stiffness matrix must be square, got {} x {}", who, n, stiffness.cols()));
  }
  if (n != inverse_masses.size()) {
    throw std::invalid_argument(
        sentence("{}: masses must be one for each of {} coordinates, got {}", who, n, inverse_masses.size()));
  }
  if (!stiffness.allFinite()) {
    throw std::invalid_argument(sentence("{}: the stiffness matrix must be finite", who));
  }
  if (stiffness != stiffness.transpose()) {
    throw std::invalid_argument(sentence("{}: the stiffness matrix must be symmetric; use (K + K^T)/2", who));
  }
  const Eigen::VectorXd root = inverse_masses.cwiseSqrt();
  const Eigen::MatrixXd weighted = root.asDiagonal() * stiffness * root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weighted);
  const double largest = std::max(0.0, solver.eigenvalues().maxCoeff());
  // The solver's eigenvalues are off by up to about n eps |K|: below that, a frequency is zero.
  const double rounding = 8.0 * static_cast<double>(n) * 2.2e-16 * std::max(largest, weighted.stableNorm());
  Eigen::VectorXd squares = solver.eigenvalues();
  if (squares.minCoeff() < -rounding) {
    throw std::invalid_argument(
        sentence("{}: eigenvalues of the stiffness matrix must be >= 0, got {}: the motion is "
                 "unbounded",
                 who, squares.minCoeff()));
  }
  for (auto& square : squares) square = square <= rounding ? 0.0 : square;
  return {solver.eigenvectors(), squares.cwiseSqrt()};
}

}  // namespace nysalt
