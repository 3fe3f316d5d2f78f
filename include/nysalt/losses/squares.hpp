// SPDX-License-Identifier: BSL-1.0
// A loss as the sum of squares that it is: the result of a pass over the data.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "nysalt/shard.hpp"

namespace nysalt {

/// Sums of residuals r with the Jacobian J by theta: the loss r^T r, half its gradient J^T r, and J^T J,
/// which is half of Gauss-Newton's Hessian.
struct squares {
  double value = 0.0;             ///< r^T r
  Eigen::VectorXd half_gradient;  ///< J^T r
  Eigen::MatrixXd normal_matrix;  ///< J^T J

  Eigen::VectorXd gradient() const;  ///< gradient of the loss: 2 J^T r
  /// Whether all numbers are.
  bool is_finite() const;
};

/// theta as an array, the form of families.
template <std::size_t N>
std::array<double, N> array_of(const Eigen::VectorXd& theta) {
  std::array<double, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = theta[static_cast<Eigen::Index>(k)];
  return result;
}
/// theta as a column vector.
template <std::size_t N>
Eigen::VectorXd column_of(const std::array<double, N>& theta) {
  return Eigen::Map<const Eigen::VectorXd>(theta.data(), static_cast<Eigen::Index>(N));
}

/// A loss as a function of theta only: a search need not know what is behind it.
using objective = std::function<squares(const Eigen::VectorXd& theta)>;

namespace detail {

/// Column of a trajectory: r^T r, J^T r and the upper triangle of J^T J.
squares from_column(const Eigen::VectorXd& column, Eigen::Index parameters);
Eigen::Index terms_of_column(Eigen::Index parameters);

/// A column of (r, J): `rows` numbers that are `stride` apart.
template <class R>
struct column_of_residuals {
  const R* first;
  std::size_t stride;
  std::size_t rows;
};

/// The products of a column with `Count` columns side by side, from `others` on. Their sums stay in
/// registers.
template <std::size_t Count, class R>
R* products_of_columns(const column_of_residuals<R>& one, const column_of_residuals<R>& others, R* products) {
  std::array<R, Count> sums;
  sums.fill(R(0.0));
  for (std::size_t k = 0; k < one.rows; ++k) {
    const R& left = one.first[k * one.stride];
    const R* const right = others.first + k * others.stride;
    for (std::size_t c = 0; c < Count; ++c) sums[c] += right[c] * left;
  }
  return std::copy(sums.begin(), sums.end(), products);
}

/// The same of `count` columns side by side.
template <class R>
R* products_of_columns(const column_of_residuals<R>& one, column_of_residuals<R> others, std::size_t count,
                       R* products) {
  for (; count >= 4; count -= 4, others.first += 4) products = products_of_columns<4>(one, others, products);
  if (count == 3) return products_of_columns<3>(one, others, products);
  if (count == 2) return products_of_columns<2>(one, others, products);
  return count == 1 ? products_of_columns<1>(one, others, products) : products;
}

/// The terms of a window: row after row of the upper triangle of (r, J)^T (r, J).
template <class Residuals, class R>
void products_of_residuals(const Residuals& r, std::vector<R>& terms) {
  const std::size_t parameters = r.parameters;
  const column_of_residuals<R> values{r.values.data(), 1, r.values.size()};
  column_of_residuals<R> slopes{r.slopes.data(), parameters, r.values.size()};
  R* next = products_of_columns(values, values, 1, terms.data());
  next = products_of_columns(values, slopes, parameters, next);
  for (std::size_t i = 0; i < parameters; ++i, ++slopes.first) {
    next = products_of_columns(slopes, slopes, parameters - i, next);
  }
}

template <class Loss>
std::vector<Eigen::VectorXd> squares_by_trajectory(const Loss& loss, const Eigen::VectorXd& theta) {
  using R = typename Loss::scalar;
  const auto of_window = [](const auto& r, std::vector<R>& terms) { products_of_residuals(r, terms); };
  return loss.sums(theta, true, terms_of_column(loss.parameters()), of_window);
}

}  // namespace detail

/// The contribution of each trajectory of this rank to the loss. Cost: one pass over the data.
template <class Loss>
std::vector<double> trajectory_losses(const Loss& loss, const Eigen::VectorXd& theta) {
  using R = typename Loss::scalar;
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    R sum(0.0);
    for (const R& x : r.values) sum += x * x;
    terms[0] = sum;
  };
  std::vector<double> result;
  for (const auto& sum : loss.sums(theta, false, 1, of_window)) result.push_back(sum[0]);
  return result;
}
/// The loss, of all ranks. Cost: one pass over the data.
template <class Loss>
double loss_value(const Loss& loss, const Eigen::VectorXd& theta) {
  return loss.share().sum(trajectory_losses(loss, theta));
}

/// The contribution of each trajectory of this rank to the gradient of the loss. Cost: a pass with
/// derivatives, as for all below.
template <class Loss>
std::vector<Eigen::VectorXd> trajectory_gradients(const Loss& loss, const Eigen::VectorXd& theta) {
  std::vector<Eigen::VectorXd> result;
  for (const auto& column : detail::squares_by_trajectory(loss, theta)) {
    result.push_back(2.0 * column.segment(1, loss.parameters()));
  }
  return result;
}
/// The loss and its derivatives, of all ranks. They pass on 1 + P + P (P + 1)/2 numbers for P parameters,
/// however many the data.
template <class Loss>
squares squares_at(const Loss& loss, const Eigen::VectorXd& theta) {
  const auto by_trajectory = detail::squares_by_trajectory(loss, theta);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(detail::terms_of_column(loss.parameters()));
  const auto sum = loss.share().sum(by_trajectory, zero);
  return detail::from_column(sum, loss.parameters());
}
/// A loss over data as a function of theta only. Refers to the loss.
template <class Loss>
objective objective_of(const Loss& loss) {
  return [&loss](const Eigen::VectorXd& theta) { return squares_at(loss, theta); };
}

/// The part of each residual in the loss, of all ranks. Cost: one pass over the data.
template <class Loss>
Eigen::VectorXd residual_squares(const Loss& loss, const Eigen::VectorXd& theta) {
  using R = typename Loss::scalar;
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    for (std::size_t k = 0; k < r.values.size(); ++k) terms[k] = r.values[k] * r.values[k];
  };
  const auto residuals = static_cast<Eigen::Index>(loss.residuals());
  const auto by_trajectory = loss.sums(theta, false, residuals, of_window);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(residuals);
  return loss.share().sum(by_trajectory, zero);
}

/// The contribution of each trajectory of this rank to the gradient of the loss, by residual: a column each.
template <class Loss>
std::vector<Eigen::MatrixXd> residual_gradients(const Loss& loss, const Eigen::VectorXd& theta) {
  using R = typename Loss::scalar;
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    std::size_t term = 0;
    for (std::size_t k = 0; k < r.values.size(); ++k) {
      for (std::size_t i = 0; i < r.parameters; ++i) terms[term++] = r.values[k] * r.slope(k, i) * 2.0;
    }
  };
  const auto residuals = static_cast<Eigen::Index>(loss.residuals());
  std::vector<Eigen::MatrixXd> result;
  for (const auto& sum : loss.sums(theta, true, loss.parameters() * residuals, of_window)) {
    result.push_back(sum.reshaped(loss.parameters(), residuals));
  }
  return result;
}

}  // namespace nysalt
