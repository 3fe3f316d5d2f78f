// SPDX-License-Identifier: BSL-1.0
// In which coordinates, and with which weights, an error of one step counts.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/sentence.hpp"

namespace nysalt {

/// qp      every q_i and p_i, each weighted with its own mean square increment [li_lu_tao_ye_2023, (3.5)]
/// modes   the same in the system's orthonormal modes x = U^T M^{1/2} q, y = U^T M^{-1/2} p
/// energy  omega_k x_k and y_k with one common weight: the energy norm of the quadratic part
enum class coordinates { qp, modes, energy };

/// The name: qp, modes or energy.
std::string to_string(coordinates c);

/// r = Sigma^{-1/2} (the difference of two states in the chosen coordinates), Sigma the mean square
/// increment over the data. The weights come from training data, and then judge any data alike.
template <int N>
class metric {
 public:
  /// Throws std::invalid_argument if the system has no modes, or (energy) a mode of frequency zero, if
  /// nothing moves in the data, or so far that a weight is not finite.
  template <System S>
  metric(const S& system, const flow_map_data<N>& data, coordinates which) : size_(size(system)) {
    if (which != coordinates::qp) change_coordinates(system, which);
    weigh(data, which);
  }

  /// Number of coordinates that count: 2 N less those that never move.
  Eigen::Index residuals() const { return static_cast<Eigen::Index>(active_.size()); }
  /// Names of coordinates without motion, which have no scale and are left out.
  const std::vector<std::string>& dropped() const { return dropped_; }

  /// The weights are estimates too. Row k, column m: what trajectory m adds to the relative error of the
  /// mean square increment of coordinate k; a row sums to zero.
  const Eigen::MatrixXd& weight_deviations() const { return deviations_; }

  /// r[0..residuals()) of the difference a - b; b is data, a may carry derivatives.
  template <Scalar T, Scalar R>
  void residual(const vector<T, N>& aq, const vector<T, N>& ap, const phase_point<R, N>& b, T* r) const {
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Eigen::Index row = active_[k];
      const bool is_q = row < size_;
      const Eigen::Index i = is_q ? row : row - size_;
      const auto& a = is_q ? aq : ap;
      const auto& target = is_q ? b.q : b.p;
      if (to_x_.size() == 0) {
        r[k] = (a[i] - target[i]) * weight_[row];
      } else {
        const auto& to = is_q ? to_x_ : to_y_;
        T sum = (a[0] - target[0]) * to(i, 0);
        for (Eigen::Index j = 1; j < size_; ++j) sum += (a[j] - target[j]) * to(i, j);
        r[k] = sum * weight_[row];
      }
    }
  }

 private:
  template <System S>
  void change_coordinates(const S& system, coordinates which) {
    if constexpr (HasModes<S>) {
      const normal_modes modes = system.modes();
      to_x_ = modes.basis.transpose();
      to_y_ = to_x_;
      if constexpr (HasInverseMass<S>) {
        for (Eigen::Index i = 0; i < size_; ++i) {
          const double root = std::sqrt(system.inverse_mass(i));
          to_x_.col(i) /= root;
          to_y_.col(i) *= root;
        }
      }
      if (which == coordinates::energy) {
        for (Eigen::Index k = 0; k < size_; ++k) {
          if (modes.frequencies[k] == 0.0) {
            throw std::invalid_argument(sentence(
                "the energy coordinates of {} do not exist: mode {} has frequency zero; use modes or qp",
                describe(system), k + 1));
          }
          to_x_.row(k) *= modes.frequencies[k];
        }
      }
    } else {
      throw std::invalid_argument(
          sentence("the {} coordinates of {} are not known: it has no modes(); use qp", to_string(which),
                   describe(system)));
    }
  }

  void weigh(const flow_map_data<N>& data, coordinates which) {
    weight_ = Eigen::VectorXd::Ones(2 * size_);
    for (Eigen::Index row = 0; row < 2 * size_; ++row) active_.push_back(row);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2 * size_);
    Eigen::VectorXd increment = zero;
    std::vector<Eigen::VectorXd> squares(data.trajectories(), zero);  // a term a trajectory
    std::vector<Eigen::VectorXd> sizes(data.trajectories(), zero);
    const auto total = static_cast<double>(data.all_pairs());
    for (std::size_t m = 0; m < data.trajectories(); ++m) {
      for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
        residual(data.finish[n].q, data.finish[n].p, data.start[n], increment.data());
        squares[m] += increment.cwiseAbs2() / total;
        add_sizes_of_terms(data.finish[n], total, sizes[m]);
      }
      if (which == coordinates::energy) squares[m].setConstant(mean_of(squares[m]));
    }
    const Eigen::VectorXd sigma = data.share().sum(squares, zero);
    const Eigen::VectorXd magnitudes = data.share().sum(sizes, zero);
    active_.clear();
    for (Eigen::Index row = 0; row < 2 * size_; ++row) {
      if (!std::isfinite(sigma[row]) || !std::isfinite(magnitudes[row])) {
        throw std::invalid_argument(
            sentence("the weight of {} is not finite: its increments in the data are too large to be squared",
                     name_of(row, which)));
      }
      // Motion below the rounding of the coordinate's own sum is none: its weight would amplify noise.
      constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
      if (sigma[row] > rounding * rounding * magnitudes[row]) {
        weight_[row] = 1.0 / std::sqrt(sigma[row]);
        active_.push_back(row);
      } else {
        dropped_.push_back(name_of(row, which));
      }
    }
    if (active_.empty())
      throw std::invalid_argument("nothing moves in the data: there is nothing to learn from");
    deviations_.resize(residuals(), static_cast<Eigen::Index>(data.trajectories()));
    for (std::size_t m = 0; m < data.trajectories(); ++m) {
      const double share = static_cast<double>(data.first_of[m + 1] - data.first_of[m]) / total;
      for (Eigen::Index k = 0; k < residuals(); ++k) {
        const Eigen::Index row = active_[static_cast<std::size_t>(k)];
        deviations_(k, static_cast<Eigen::Index>(m)) = squares[m][row] / sigma[row] - share;
      }
    }
  }

  std::string name_of(Eigen::Index row, coordinates which) const {
    const std::string_view names = which == coordinates::qp ? "qp" : "xy";
    return sentence("{}{}", names[row < size_ ? 0 : 1], row % size_ + 1);
  }

  static double mean_of(const Eigen::VectorXd& values) {
    double sum = 0.0;
    for (const double x : values) sum += x;
    return sum / static_cast<double>(values.size());
  }

  /// sizes += x^2/total for each coordinate's sum x of absolute terms: what its rounding is relative to.
  void add_sizes_of_terms(const phase_point<double, N>& x, double total, Eigen::VectorXd& sizes) const {
    for (Eigen::Index i = 0; i < size_; ++i) {
      const double of_x = size_of_terms(to_x_, i, x.q);
      const double of_y = size_of_terms(to_y_, i, x.p);
      sizes[i] += of_x * of_x / total;
      sizes[size_ + i] += of_y * of_y / total;
    }
  }
  static double size_of_terms(const Eigen::MatrixXd& to, Eigen::Index i, const vector<double, N>& a) {
    if (to.size() == 0) return std::abs(a[i]);
    double sum = 0.0;
    for (Eigen::Index j = 0; j < a.size(); ++j) sum += std::abs(to(i, j) * a[j]);
    return sum;
  }

  Eigen::Index size_;
  Eigen::MatrixXd to_x_;  // empty for qp
  Eigen::MatrixXd to_y_;
  Eigen::VectorXd weight_;
  Eigen::MatrixXd deviations_;
  std::vector<Eigen::Index> active_;
  std::vector<std::string> dropped_;
};

}  // namespace nysalt
