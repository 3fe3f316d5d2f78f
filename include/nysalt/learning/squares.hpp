// SPDX-License-Identifier: BSL-1.0
// A loss as the sum of squares that it is: what a pass over the data tells.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "nysalt/scalars/dual.hpp"
#include "nysalt/tree_sum.hpp"

namespace nysalt {

template <class Loss>
inline constexpr int parameters_v = Loss::family::parameters;
template <class Loss>
using theta_of = std::array<double, static_cast<std::size_t>(parameters_v<Loss>)>;

/// Of residuals r with the Jacobian J by theta: the loss r^T r, half its gradient J^T r, and J^T J, which is
/// half of Gauss-Newton's Hessian.
struct squares {
  double value = 0.0;
  Eigen::VectorXd half_gradient;
  Eigen::MatrixXd normal_matrix;

  Eigen::VectorXd gradient() const { return 2.0 * half_gradient; }
  bool is_finite() const {
    return std::isfinite(value) && half_gradient.allFinite() && normal_matrix.allFinite();
  }
};

/// theta as families hold it, and as linear algebra does.
template <std::size_t N>
std::array<double, N> array_of(const Eigen::VectorXd& theta) {
  std::array<double, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = theta[static_cast<Eigen::Index>(k)];
  return result;
}
template <std::size_t N>
Eigen::VectorXd column_of(const std::array<double, N>& theta) {
  return Eigen::Map<const Eigen::VectorXd>(theta.data(), static_cast<Eigen::Index>(N));
}

/// A loss as a function of theta alone: whoever searches need not know what is behind it.
using objective = std::function<squares(const Eigen::VectorXd& theta)>;

namespace detail {

/// Column of a trajectory: r^T r, J^T r and the upper triangle of J^T J.
template <int P>
using column_of_squares = Eigen::Matrix<double, 1 + P + P*(P + 1) / 2, 1>;

template <int P>
squares from_column(const column_of_squares<P>& column) {
  squares result{column[0], column.template segment<P>(1), Eigen::MatrixXd(P, P)};
  Eigen::Index term = 1 + P;
  for (Eigen::Index i = 0; i < P; ++i) {
    for (Eigen::Index j = i; j < P; ++j, ++term) {
      result.normal_matrix(i, j) = column[term];
      result.normal_matrix(j, i) = column[term];
    }
  }
  return result;
}

/// theta with derivatives by itself, in all lanes.
template <class Loss>
auto with_derivatives(const theta_of<Loss>& theta) {
  using D = dual<typename Loss::scalar, parameters_v<Loss>>;
  std::array<D, theta_of<Loss>{}.size()> result;
  for (std::size_t k = 0; k < theta.size(); ++k) result[k] = D::variable(theta[k], static_cast<int>(k));
  return result;
}

template <class Loss>
auto squares_by_trajectory(const Loss& loss, const theta_of<Loss>& theta) {
  using column = column_of_squares<parameters_v<Loss>>;
  using R = typename Loss::scalar;
  constexpr std::size_t count = theta_of<Loss>{}.size();
  const auto of_pair = [](const auto& residuals, std::vector<R>& terms) {
    std::array<R, static_cast<std::size_t>(column::SizeAtCompileTime)> sums;
    sums.fill(R(0.0));
    for (const auto& r : residuals) {
      std::size_t term = 0;
      sums[term++] += r.value * r.value;
      for (std::size_t i = 0; i < count; ++i) sums[term++] += r.derivative[i] * r.value;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i; j < count; ++j) sums[term++] += r.derivative[i] * r.derivative[j];
      }
    }
    for (std::size_t term = 0; term < sums.size(); ++term) terms[term] = sums[term];
  };
  return loss.sums(with_derivatives<Loss>(theta), column(column::Zero()), of_pair);
}

}  // namespace detail

/// What each trajectory adds to the loss. Cost: one pass over the data.
template <class Loss>
std::vector<double> trajectory_losses(const Loss& loss, const theta_of<Loss>& theta) {
  using R = typename Loss::scalar;
  using column = Eigen::Matrix<double, 1, 1>;
  std::array<R, theta_of<Loss>{}.size()> constant;
  for (std::size_t k = 0; k < theta.size(); ++k) constant[k] = R(theta[k]);
  const auto of_pair = [](const auto& residuals, std::vector<R>& terms) {
    R sum(0.0);
    for (const R& r : residuals) sum += r * r;
    terms[0] = sum;
  };
  std::vector<double> result;
  for (const auto& sum : loss.sums(constant, column(column::Zero()), of_pair)) result.push_back(sum[0]);
  return result;
}
template <class Loss>
double loss_value(const Loss& loss, const theta_of<Loss>& theta) {
  return tree_sum(trajectory_losses(loss, theta));
}

/// What each trajectory adds to the gradient of the loss. Cost: one pass with derivatives, as for all below.
template <class Loss>
std::vector<Eigen::VectorXd> trajectory_gradients(const Loss& loss, const theta_of<Loss>& theta) {
  std::vector<Eigen::VectorXd> result;
  for (const auto& column : detail::squares_by_trajectory(loss, theta)) {
    result.push_back(2.0 * column.template segment<parameters_v<Loss>>(1));
  }
  return result;
}
template <class Loss>
squares squares_at(const Loss& loss, const theta_of<Loss>& theta) {
  return detail::from_column<parameters_v<Loss>>(tree_sum(detail::squares_by_trajectory(loss, theta)));
}
/// Refers to the loss.
template <class Loss>
objective objective_of(const Loss& loss) {
  constexpr std::size_t count = theta_of<Loss>{}.size();
  return [&loss](const Eigen::VectorXd& theta) { return squares_at(loss, array_of<count>(theta)); };
}

/// What each trajectory adds to the gradient of the loss, by coordinate of the metric: a column each.
template <class Loss>
std::vector<Eigen::MatrixXd> coordinate_gradients(const Loss& loss, const theta_of<Loss>& theta) {
  using R = typename Loss::scalar;
  const auto of_pair = [](const auto& residuals, std::vector<R>& terms) {
    std::size_t term = 0;
    for (const auto& r : residuals) {
      for (const R& slope : r.derivative) terms[term++] = r.value * slope * 2.0;
    }
  };
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(parameters_v<Loss>, static_cast<Eigen::Index>(loss.residuals()));
  return loss.sums(detail::with_derivatives<Loss>(theta), zero, of_pair);
}

}  // namespace nysalt
