// SPDX-License-Identifier: BSL-1.0
#include "dense.hpp"

#include <Eigen/Dense>

namespace nysalt::test {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a) { return a.eigenvalues(); }

double spectral_radius(const Eigen::MatrixXd& a) { return eigenvalues(a).cwiseAbs().maxCoeff(); }

symmetric_eigen::symmetric_eigen(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
}

double spectral_norm(const Eigen::MatrixXd& a) { return a.jacobiSvd().singularValues()[0]; }

Eigen::VectorXd solution_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.partialPivLu().solve(b);
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(threshold);
  return solver.compute(a).solve(b);
}

Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& a) { return a.householderQr().householderQ(); }

}  // namespace nysalt::test
