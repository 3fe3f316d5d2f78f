// SPDX-License-Identifier: BSL-1.0
// Matrices: decompositions, compiled once for all tests as their templates are dear, and a word on the
// oscillator.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nysalt/derivatives/oscillator.hpp"

namespace nysalt::test {

/// Eigenvalues of a square matrix.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

/// The largest absolute value of an eigenvalue.
double spectral_radius(const Eigen::MatrixXd& a);

/// Of a symmetric matrix: eigenvalues in ascending order, and the eigenvector of each as a column.
struct symmetric_eigen {
  explicit symmetric_eigen(const Eigen::MatrixXd& a);
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// The largest singular value.
double spectral_norm(const Eigen::MatrixXd& a);

double determinant(const Eigen::MatrixXd& a);

/// The shortest x that has a x nearest to b; pivots below the threshold, relative to the largest, are zero.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold);

/// An orthogonal matrix whose first columns span those of a.
Eigen::MatrixXd orthogonal_basis(const Eigen::MatrixXd& a);

}  // namespace nysalt::test
