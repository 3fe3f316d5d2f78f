// SPDX-License-Identifier: BSL-1.0
// A loss as the sum of squares that it is.
#include "nysalt/losses/squares.hpp"

#include <cmath>

namespace nysalt {

Eigen::VectorXd squares::gradient() const { return 2.0 * half_gradient; }

bool squares::is_finite() const {
  return std::isfinite(value) && half_gradient.allFinite() && normal_matrix.allFinite();
}

namespace detail {

squares from_column(const Eigen::VectorXd& column, Eigen::Index parameters) {
  squares result{column[0], column.segment(1, parameters), Eigen::MatrixXd(parameters, parameters)};
  Eigen::Index term = 1 + parameters;
  for (Eigen::Index i = 0; i < parameters; ++i) {
    for (Eigen::Index j = i; j < parameters; ++j, ++term) {
      result.normal_matrix(i, j) = column[term];
      result.normal_matrix(j, i) = column[term];
    }
  }
  return result;
}

Eigen::Index terms_of_column(Eigen::Index parameters) {
  return 1 + parameters + parameters * (parameters + 1) / 2;
}

}  // namespace detail

}  // namespace nysalt
