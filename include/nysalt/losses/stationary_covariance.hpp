// SPDX-License-Identifier: BSL-1.0
// The covariance that a linear step with noise keeps, and its error as a loss.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "nysalt/bath.hpp"
#include "nysalt/family.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/model.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

// The distance of the stationary distribution of a thermostatted word from the Gibbs distribution, mode by
// mode.

/// On a mode of frequency omega > 0, x = omega q/sqrt(kT) and y = p/sqrt(kT) have the covariance 1 in the
/// Gibbs distribution. A word steps them by (x, y) <- M (x, y) + normal noise, and the distribution after a
/// step has the covariance 1 + D that solves a discrete Lyapunov equation. The loss is the sum of D_xx^2 + 2
/// D_xy^2 + D_yy^2 over the modes: each gives the residuals D_xx, sqrt(2) D_xy and D_yy. They have no units,
/// and depend on h omega and gamma h only.
///
/// Why these weights: but for third powers of D the loss is four times the Kullback-Leibler divergence of the
/// word's distribution from the Gibbs distribution, and that adds up over modes. So a frequency that r modes
/// share counts r times, and by Pinsker's inequality no observable of the modes errs by more than
/// sqrt(loss/8) in total variation. Positions count as much as momenta, as they do in energies; for the
/// distribution of positions only BAOAB is exact at one evaluation. Where D vanishes no weight matters: for
/// O/2 S O/2 and S O it does where S turns the circle x^2 + y^2 = 1, as O keeps it.
///
/// Modes of frequency zero are left out, as they have no stationary distribution of their own, and so is all
/// that is not quadratic.
class stationary_covariance {
 public:
  /// Loss of a word with letters O. Throws std::invalid_argument if it has none, or a letter that the system
  /// does not serve; if the system is in no bath or declares no modes; if the bath has no friction or no
  /// temperature; if no frequency is above zero; or if the step is not positive and finite.
  stationary_covariance(const model& system, const nysalt::word& word, double step);

  /// Three for each distinct frequency, from the lowest up, times the root of its multiplicity.
  /// Infinite where the word has no stationary distribution: its spectral radius is not below 1, or a letter
  /// O goes back in time. T is double, or a dual of it with two derivatives. Cost: each letter twice for each
  /// frequency, on one number. Throws std::invalid_argument unless there is a coefficient for each slot.
  template <Scalar T>
  std::vector<T> residuals(const std::vector<T>& coefficients) const;

  /// The loss and its derivatives by theta, from the coefficients at theta and their Jacobian: a row for
  /// each coefficient, a column for each parameter.
  squares at(const std::vector<double>& coefficients, const Eigen::MatrixXd& jacobian) const;

 private:
  /// A letter O, or all letters between two letters O.
  struct piece {
    std::size_t first;  // of its slots
    std::optional<nysalt::word> turn;
  };

  void require_law() const;
  void split_at_bath();
  /// The D by which the covariance 1 + D after a step differs from 1.
  template <Scalar T>
  Eigen::Matrix<T, 2, 2> excess(double omega, const std::vector<T>& coefficients) const;

  nysalt::word word_;
  double step_;
  bath bath_;
  std::map<double, int> multiplicity_of_;  // of each frequency
  std::vector<piece> pieces_;
};

namespace detail {

/// The loss as a function of theta only, for a family with the letters of the loss.
objective objective_of(const stationary_covariance& loss, const family& family);

}  // namespace detail

}  // namespace nysalt
