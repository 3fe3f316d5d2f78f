// SPDX-License-Identifier: BSL-1.0
// Derivatives of the force and their eigenvalues: frequencies at a state.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt::detail {

/// The length of each coordinate, from where points are: the distance between the lowest and the highest. Of
/// a coordinate that does not move, the length of the coordinate that moves farthest; if none moves, how far
/// all are from the origin, and 1 if they are there.
Eigen::VectorXd lengths_of(const std::vector<Eigen::VectorXd>& points);

/// A factor L of K''(p) = L L^T; empty where K''(p) is not positive semidefinite.
Eigen::MatrixXd kinetic_factor(const model& system, const Eigen::VectorXd& p);

}  // namespace nysalt::detail

// Products with f'(q) at one state after the other, of any force.

namespace nysalt {

namespace detail {

/// f'(q) v of a field at states of a motion. Differences of a black box go a part of how far the states lie
/// apart.
class force_jacobian {
 public:
  /// The Jacobian of the force on the motion that passes through these states.
  force_jacobian(const model& system, const phase_points& states, field of = field::whole);

  /// Moves to the state where the next products are taken. Cost: a force, of a black box.
  void move_to(const Eigen::VectorXd& q);
  /// f'(q) v. Cost: one directional derivative.
  const Eigen::VectorXd& times(const Eigen::VectorXd& v);
  /// V''(q), or the Hessian of the soft part of V, where f is the soft force; the next products are taken
  /// there. Cost: as many directional derivatives as there are degrees of freedom.
  Eigen::MatrixXd potential_hessian(const Eigen::VectorXd& q);

 private:
  model system_;
  field field_;
  bool differs_;  // by differences as long as a displacement
  lifted_room<double, Eigen::Dynamic> room_;
  Eigen::VectorXd q_;
  Eigen::VectorXd v_;
  Eigen::VectorXd f_;
  Eigen::VectorXd g_;
  Eigen::VectorXd lengths_;
};

}  // namespace detail

// Both ends of a symmetric spectrum, from products with vectors only.

namespace detail {

/// Both ends of a spectrum, with approximate eigenvectors.
struct spectrum_ends {
  double lowest;                      ///< a bound from below of the lowest eigenvalue found
  double highest;                     ///< a bound from above of the highest eigenvalue found
  Eigen::VectorXd lowest_direction;   ///< the Ritz vector of the lowest, of length 1
  Eigen::VectorXd highest_direction;  ///< the Ritz vector of the highest, of length 1
  int products;                       ///< applications of the map
};

/// A symmetric map v -> A v.
using symmetric_map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// The ends of the spectrum of A, from a start with a part in every direction [lanczos_1950]. Each
/// end is a Ritz value moved outwards by its residual, so that it bounds the eigenvalue that it belongs to;
/// of many close ones that may be another than the last, less than the error away. It stops when the
/// residuals are below relative_error of the highest end (or of 1 % of the lowest, if that is larger in size)
/// and of the larger of both; after 100 products they are what they are. Unlike power iteration it needs no
/// shift where negative ends are larger in size than positive ones. Both ends are NaN if a product is not
/// finite. Cost: some 8 to 40 products, and k^2 dot products for k.
spectrum_ends ends_of_spectrum(const symmetric_map& multiply, const Eigen::VectorXd& start,
                               double relative_error = 0.01);

}  // namespace detail

// Extreme eigenvalues of the Hessian along the motion: stiffness and instability.

/// Eigenvalues of -M^{-1/2} f'(q) M^{-1/2} over some states: squares of frequencies, or, where negative, of
/// rates at which neighbours part.
struct stiffness_range {
  double lowest = std::numeric_limits<double>::infinity();  ///< least eigenvalue of all states
  /// Largest eigenvalue of all states.
  double highest = -std::numeric_limits<double>::infinity();
  std::vector<double> highest_of_state;  ///< largest eigenvalue of each state
  std::int64_t states = 0;               ///< number of states examined
  std::int64_t evaluations = 0;          ///< evaluations of f'(q) v

  /// sqrt(highest), 0 if that is negative.
  double highest_frequency() const { return std::sqrt(std::max(0.0, highest)); }
};

/// Range of the Hessian's spectrum over all states, of the whole force or of its soft part, of a system with
/// a quadratic kinetic energy. Both ends are known to 1 % and mostly rounded outwards, see
/// ends_of_spectrum(); who needs a bound adds a percent. The same states give the same bits. Differences of a
/// black box go a part of how far the states lie apart. Cost: some 8 to 40 directional derivatives a state,
/// less below 8 dimensions. Throws std::invalid_argument if there are no states, or one where the force has
/// no finite derivative.
stiffness_range hessian_spectrum(const model& system, const phase_points& states, field of = field::whole);

// All frequencies of the linearised motion at a state, for any separable Hamiltonian.

namespace detail {

/// Frequencies of the linearised motion at (q, p), from low to high: square roots of the eigenvalues of
/// K''(p) V''(q), 0 where negative. Empty where K''(p) is not positive semidefinite. Throws
/// std::invalid_argument if a derivative is not finite, and std::logic_error if grad K cannot be
/// differentiated. Cost: as many directional derivatives as there are degrees of freedom, and the eigenvalues
/// of a matrix of that size.
std::vector<double> frequencies_at(const model& system, const phase_point<double, Eigen::Dynamic>& state);

/// Frequencies along some states.
struct frequencies_along {
  std::vector<std::vector<double>> of_state;  ///< frequencies of each state, from low to high
  bool are_complete = false;                  ///< false: of each state only the highest, or none at all

  /// A frequency and the state where it occurs.
  struct maximum {
    double frequency = 0.0;  ///< frequency of the linearised motion
    std::size_t state = 0;   ///< number of the state
  };
  /// The highest frequency and the state where it occurs; 0 and 0 if none is known.
  maximum highest() const {
    maximum result;
    for (std::size_t k = 0; k < of_state.size(); ++k) {
      if (of_state[k].empty() || of_state[k].back() <= result.frequency) continue;
      result = {of_state[k].back(), k};
    }
    return result;
  }
};

/// Above this number of degrees of freedom only the highest frequency of a state is computed.
inline constexpr Eigen::Index most_for_all_frequencies = 64;

/// All frequencies of each state of a system of at most most_for_all_frequencies degrees of freedom; of a
/// larger one with a quadratic kinetic energy the highest, known to 1 %; else none. Throws what
/// frequencies_at() and hessian_spectrum() do. Cost: for each state one frequencies_at(), or 8 to 40
/// directional derivatives.
frequencies_along frequencies_of_states(const model& system, const phase_points& states);

}  // namespace detail

}  // namespace nysalt
