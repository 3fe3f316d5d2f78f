// SPDX-License-Identifier: BSL-1.0
// Passes of losses over the data.

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "after_steps.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

namespace {

double mean_of(const Eigen::VectorXd& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

double size_of_terms(const auto& sums, Eigen::Index i, const auto& a) {
  if (sums.empty()) return std::abs(a[i]);
  double sum = 0.0;
  for (const auto& [j, factor] : sums[static_cast<std::size_t>(i)]) sum += std::abs(factor * a[j]);
  return sum;
}

/// sizes += x^2/total for each coordinate's sum x of absolute terms: what its rounding is relative to.
void add_sizes_of_terms(const auto& x, const auto& sums_of_q, const auto& sums_of_p, double total,
                        Eigen::VectorXd& sizes) {
  const Eigen::Index size = x.size();
  for (Eigen::Index i = 0; i < size; ++i) {
    const double of_x = size_of_terms(sums_of_q, i, x.q);
    const double of_y = size_of_terms(sums_of_p, i, x.p);
    sizes[i] += of_x * of_x / total;
    sizes[size + i] += of_y * of_y / total;
  }
}

}  // namespace

std::string to_string(coordinates c) {
  return c == coordinates::qp ? "qp" : c == coordinates::modes ? "modes" : "energy";
}

metric::metric(const model& system, const flow_map_data& data, coordinates which)
    : size_(size(system)), which_(which) {
  if (which != coordinates::qp) change_coordinates(system, which);
  weigh(data);
}

void metric::change_coordinates(const model& system, coordinates which) {
  if (!has_modes(system)) {
    throw std::invalid_argument(
        fmt::format("a loss in {} coordinates: the system must have modes(), got {}; use qp",
                    to_string(which), describe(system)));
  }
  const auto modes = detail::modal_coordinates::of(system);
  sums_of_q_.resize(static_cast<std::size_t>(size_));
  sums_of_p_.resize(static_cast<std::size_t>(size_));
  for (const auto& [i, k, heavy, light] : modes->entries()) {
    const auto row = static_cast<std::size_t>(k);
    const double omega = modes->frequencies()[row];
    const bool is_scaled = which == coordinates::energy && omega != 0.0;
    sums_of_q_[row].push_back({i, is_scaled ? heavy * omega : heavy});
    sums_of_p_[row].push_back({i, light});
  }
}

/// What each trajectory adds to the mean square of each increment, in residuals as they are: a common one in
/// the energy norm.
std::vector<Eigen::VectorXd> metric::squares_in(const flow_map_data& data) const {
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(residuals());
  std::vector<Eigen::VectorXd> squares(data.trajectories(), increment);
  const auto total = static_cast<double>(data.all_pairs());
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      residual(data.finish[n].q, data.finish[n].p, data.start[n], increment.data());
      squares[m] += increment.cwiseAbs2() / total;
    }
    if (which_ == coordinates::energy) squares[m].setConstant(mean_of(squares[m]));
  }
  return squares;
}

void metric::weigh(const flow_map_data& data) {
  weight_ = Eigen::VectorXd::Ones(2 * size_);
  for (Eigen::Index row = 0; row < 2 * size_; ++row) active_.push_back(row);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2 * size_);
  const auto squares = squares_in(data);
  std::vector<Eigen::VectorXd> sizes(data.trajectories(), zero);
  const auto total = static_cast<double>(data.all_pairs());
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      add_sizes_of_terms(data.finish[n], sums_of_q_, sums_of_p_, total, sizes[m]);
    }
  }
  const Eigen::VectorXd sigma = data.share().sum(squares, zero);
  const Eigen::VectorXd magnitudes = data.share().sum(sizes, zero);
  active_.clear();
  for (Eigen::Index row = 0; row < 2 * size_; ++row) {
    if (!std::isfinite(sigma[row]) || !std::isfinite(magnitudes[row])) {
      throw std::invalid_argument(fmt::format(
          "the weight of {} must be finite, got increments in the data that are too large to be squared",
          name_of(row)));
    }
    // Motion below the rounding of the coordinate's own sum is none: its weight would amplify noise.
    constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
    if (sigma[row] > rounding * rounding * magnitudes[row]) {
      weight_[row] = 1.0 / std::sqrt(sigma[row]);
      active_.push_back(row);
    } else {
      dropped_.push_back(name_of(row));
    }
  }
  if (active_.empty()) throw std::invalid_argument("the data must hold motion to learn from, got none");
  deviations_.resize(residuals(), static_cast<Eigen::Index>(data.trajectories()));
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    const double share = static_cast<double>(data.first_of[m + 1] - data.first_of[m]) / total;
    for (Eigen::Index k = 0; k < residuals(); ++k) {
      const Eigen::Index row = active_[static_cast<std::size_t>(k)];
      deviations_(k, static_cast<Eigen::Index>(m)) = squares[m][row] / sigma[row] - share;
    }
  }
}

/// Relative to their own mean square: what a coordinate that moves more in these data adds to the gradient of
/// their loss, it takes back by its weight.
Eigen::MatrixXd metric::weight_deviations(const flow_map_data& others) const {
  const auto squares = squares_in(others);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(residuals());
  const Eigen::ArrayXd sum = others.share().sum(squares, zero).array();
  Eigen::MatrixXd result(residuals(), static_cast<Eigen::Index>(others.trajectories()));
  const auto total = static_cast<double>(others.all_pairs());
  for (std::size_t m = 0; m < others.trajectories(); ++m) {
    const double share = static_cast<double>(others.first_of[m + 1] - others.first_of[m]) / total;
    result.col(static_cast<Eigen::Index>(m)) = (sum > 0.0).select(squares[m].array() / sum, share) - share;
  }
  return result;
}

std::string metric::name_of(Eigen::Index row) const {
  const std::string_view names = which_ == coordinates::qp ? "qp" : "xy";
  return fmt::format("{}{}", names[row < size_ ? 0 : 1], row % size_ + 1);
}

// A loss as the sum of squares that it is.

Eigen::VectorXd squares::gradient() const { return 2.0 * half_gradient; }

bool squares::is_finite() const {
  return std::isfinite(value) && half_gradient.allFinite() && normal_matrix.allFinite();
}

// The sums over windows that a pass adds up.

namespace {

Eigen::Index terms_of_column(Eigen::Index parameters) {
  return 1 + parameters + parameters * (parameters + 1) / 2;
}

/// Squares from a column: r^T r, J^T r and the upper triangle of J^T J.
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
template <Scalar R>
void products_of_residuals(const residuals_of_window<R>& r, std::vector<R>& terms) {
  const std::size_t parameters = r.parameters;
  const column_of_residuals<R> values{r.values.data(), 1, r.values.size()};
  column_of_residuals<R> slopes{r.slopes.data(), parameters, r.values.size()};
  R* next = products_of_columns(values, values, 1, terms.data());
  next = products_of_columns(values, slopes, parameters, next);
  for (std::size_t i = 0; i < parameters; ++i, ++slopes.first) {
    next = products_of_columns(slopes, slopes, parameters - i, next);
  }
}

}  // namespace

template <Scalar R>
squares after_steps<R>::at(const Eigen::VectorXd& theta) const {
  const Eigen::Index terms = terms_of_column(parameters());
  const auto by_trajectory = sums(theta, true, terms, products_of_residuals<R>);
  return from_column(share_.sum(by_trajectory, Eigen::VectorXd(Eigen::VectorXd::Zero(terms))), parameters());
}

template <Scalar R>
std::vector<double> after_steps<R>::by_trajectory(const Eigen::VectorXd& theta) const {
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    R sum(0.0);
    for (const R& x : r.values) sum += x * x;
    terms[0] = sum;
  };
  std::vector<double> result;
  for (const auto& sum : sums(theta, false, 1, of_window)) result.push_back(sum[0]);
  return result;
}

template <Scalar R>
Eigen::VectorXd after_steps<R>::by_residual(const Eigen::VectorXd& theta) const {
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    for (std::size_t k = 0; k < r.values.size(); ++k) terms[k] = r.values[k] * r.values[k];
  };
  const auto count = static_cast<Eigen::Index>(residuals());
  return share_.sum(sums(theta, false, count, of_window), Eigen::VectorXd(Eigen::VectorXd::Zero(count)));
}

template <Scalar R>
std::vector<Eigen::MatrixXd> after_steps<R>::gradients(const Eigen::VectorXd& theta) const {
  const auto of_window = [](const auto& r, std::vector<R>& terms) {
    std::size_t term = 0;
    for (std::size_t k = 0; k < r.values.size(); ++k) {
      for (std::size_t i = 0; i < r.parameters; ++i) terms[term++] = r.values[k] * r.slope(k, i) * 2.0;
    }
  };
  const auto count = static_cast<Eigen::Index>(residuals());
  std::vector<Eigen::MatrixXd> result;
  for (const auto& sum : sums(theta, true, parameters() * count, of_window)) {
    result.push_back(sum.reshaped(parameters(), count));
  }
  return result;
}

template class after_steps<detail::lanes>;
template class after_steps<double>;

}  // namespace nysalt
