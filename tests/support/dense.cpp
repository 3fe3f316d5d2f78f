// SPDX-License-Identifier: BSL-1.0
#include "dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <cmath>

namespace nysalt::test {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a) { return a.eigenvalues(); }

double spectral_radius(const Eigen::MatrixXd& a) { return eigenvalues(a).cwiseAbs().maxCoeff(); }

symmetric_eigen::symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
}

double spectral_norm(const Eigen::MatrixXd& a) {
  return std::sqrt(symmetric_eigen(a.transpose() * a).values.maxCoeff());
}

// The eigenvalues are exact for a matrix that is a rounding of a away, as pivots of an elimination are.
double determinant(const Eigen::MatrixXd& a) { return eigenvalues(a).prod().real(); }

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(threshold);
  return solver.compute(a).solve(b);
}

Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& a) { return a.colPivHouseholderQr().householderQ(); }

}  // namespace nysalt::test
