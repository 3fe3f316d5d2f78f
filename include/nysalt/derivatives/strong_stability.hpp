// SPDX-License-Identifier: BSL-1.0
// Stability of a linear symplectic step, and how near it is to a loss of stability.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <numbers>

namespace nysalt {

/// Eigenvalues of a symplectic matrix of 2 n rows, in coordinates (q, p). Those on the unit circle have a
/// Krein signature, the sign of i x^* Omega x of their vectors x; where two of opposite signature meet an
/// arbitrarily small perturbation moves both off the circle, and where two of like signature meet none does:
/// the step is strongly stable [krein_1950], [gelfand_lidskii_1955], [hairer_lubich_wanner_2006, section
/// XIII].
struct symplectic_spectrum {
  double growth = 0.0;  ///< logarithm of the spectral radius
  /// Rounding splits a double eigenvalue that has one vector by the square root of its own size: what grows
  /// by less counts as on the circle.
  static constexpr double rounding = 1e-6;
  /// Smallest difference in phase, in radian, of two eigenvalues of opposite signature; 0 where two coincide,
  /// or where one is off the circle.
  double krein_distance = std::numbers::pi;
  /// Phase of the one of positive signature, in (-pi, pi]; where one is off the circle, of that which is
  /// farthest off.
  double first = 0.0;
  double second = 0.0;  ///< phase of the other

  /// Whether no eigenvalue is off the circle.
  bool is_on_circle() const { return growth <= rounding; }
};

/// The spectrum of a symplectic matrix. Infinite growth of one that is not finite; of no rows that of no
/// eigenvalues, a growth of 0 and a distance of pi. Throws
/// std::invalid_argument unless it is square with an even number of rows. Cost: its eigenvectors.
symplectic_spectrum spectrum_of(const Eigen::MatrixXd& step);

/// Largest |M^n| over the powers of two n <= steps, which is that over all n <= steps to a factor 2/sqrt(3)
/// where two eigenvalues come near each other: their phases, n times as far apart, pass 2 pi/3 at one of the
/// powers, and are 4 pi/3 apart at most there. At least 1; infinite where it grows beyond 10^6. Cost:
/// log2(steps) products of matrices.
double largest_power(const Eigen::MatrixXd& step, std::int64_t steps);

}  // namespace nysalt
