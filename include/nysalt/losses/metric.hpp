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

#include "nysalt/detail/sentence.hpp"
#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// qp      every q_i and p_i, each weighted with its own mean square increment [li_lu_tao_ye_2023, (3.5)]
/// modes   the same in the system's orthonormal modes x = U^T M^{1/2} q, y = U^T M^{-1/2} p
/// energy  omega_k x_k (x_k where omega_k = 0) and y_k with one common weight: the energy norm of the
/// quadratic
///         part, as the metric `state` has it
enum class coordinates { qp, modes, energy };

/// The name: qp, modes or energy.
std::string to_string(coordinates c);

/// r = Sigma^{-1/2} (the difference of two states in the chosen coordinates), Sigma the mean square
/// increment over the data. The weights come from training data, and then judge any data alike.
class metric {
 public:
  /// Throws std::invalid_argument if the system has no modes, if nothing moves in the data, or so far that
  /// a weight is not finite.
  metric(const model& system, const flow_map_data& data, coordinates which);

  /// Number of coordinates that count: 2 N less those that never move.
  Eigen::Index residuals() const { return static_cast<Eigen::Index>(active_.size()); }
  /// Names of coordinates without motion, which have no scale and are left out.
  const std::vector<std::string>& dropped() const { return dropped_; }

  /// The weights are estimates too. Row k, column m: what trajectory m adds to the relative error of the
  /// mean square increment of coordinate k; a row sums to zero.
  const Eigen::MatrixXd& weight_deviations() const { return deviations_; }
  /// The same of the trajectories of other data among each other, as if they made the weights. Collective.
  Eigen::MatrixXd weight_deviations(const flow_map_data& others) const;

  /// r[0..residuals()) of the difference a - b; b is data, a may carry derivatives.
  template <Scalar T>
  void residual(const auto& aq, const auto& ap, const auto& b, T* r) const {
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Eigen::Index row = active_[k];
      const bool is_q = row < size_;
      const Eigen::Index i = is_q ? row : row - size_;
      r[k] = is_q ? difference<T>(aq, b.q, sums_of_q_, i, weight_[row])
                  : difference<T>(ap, b.p, sums_of_p_, i, weight_[row]);
    }
  }

 private:
  /// A coordinate of the system, and its factor in a mode: modes of chains have few that are not zero.
  struct term {
    Eigen::Index coordinate;
    double factor;
  };
  using sums = std::vector<std::vector<term>>;  // one a mode; empty for qp

  template <class T>
  [[gnu::always_inline]] T difference(const auto& a, const auto& target, const sums& modes, Eigen::Index i,
                                      double weight) const {
    if (modes.empty()) return (a[i] - target[i]) * weight;
    const auto& terms = modes[static_cast<std::size_t>(i)];
    T sum = (a[terms.front().coordinate] - target[terms.front().coordinate]) * terms.front().factor;
    for (std::size_t k = 1; k < terms.size(); ++k) {
      sum += (a[terms[k].coordinate] - target[terms[k].coordinate]) * terms[k].factor;
    }
    return sum * weight;
  }

  void change_coordinates(const model& system, coordinates which);
  void weigh(const flow_map_data& data);
  std::vector<Eigen::VectorXd> squares_in(const flow_map_data& data) const;
  std::string name_of(Eigen::Index row) const;

  Eigen::Index size_;
  coordinates which_;
  sums sums_of_q_;
  sums sums_of_p_;
  Eigen::VectorXd weight_;
  Eigen::MatrixXd deviations_;
  std::vector<Eigen::Index> active_;
  std::vector<std::string> dropped_;
};

}  // namespace nysalt
