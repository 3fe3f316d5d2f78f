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

// Gaussian elimination with the largest pivot of each column.
double determinant(Eigen::MatrixXd a) {
  double result = 1.0;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < a.rows(); ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    if (a(pivot, k) == 0.0) return 0.0;
    if (pivot != k) {
      a.row(pivot).swap(a.row(k));
      result = -result;
    }
    result *= a(k, k);
    for (Eigen::Index i = k + 1; i < a.rows(); ++i) {
      const double factor = a(i, k) / a(k, k);
      for (Eigen::Index j = k + 1; j < a.cols(); ++j) a(i, j) -= factor * a(k, j);
    }
  }
  return result;
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(threshold);
  return solver.compute(a).solve(b);
}

Eigen::VectorXd solution_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return least_squares(a, b, 0.0);
}

Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& a) { return a.colPivHouseholderQr().householderQ(); }

}  // namespace nysalt::test
