// SPDX-License-Identifier: BSL-1.0
// What a check of a letter found, and the sentence that it makes.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace nysalt {

/// Defects are relative: of the symplectic form to |J|^T |Omega| |J| entry by entry, which has its units; of
/// coordinates to the largest values that each takes. They are 0 of what the letter does not claim.
struct letter_check {
  /// Half of all digits: a formula that is wrong loses more, and rounding less.
  static constexpr double tolerance = 1.5e-8;

  char letter = '?';          ///< name of the letter
  bool finite = true;         ///< states and derivatives, at all points
  bool keeps_q = true;        ///< false: q changes, though moves_q is false
  double slope_defect = 0.0;  ///< slope defect of the derivative by the coefficients, against differences
  double symplecticity_defect =
      0.0;  ///< symplecticity defect of J^T Omega J = Omega, if the letter claims `symplectic`
  double inverse_defect = 0.0;  ///< inverse defect of x(-c) after x(c), if the letter claims `invertible`
  double additivity_defect =
      0.0;  ///< additivity defect of x(d) after x(c) against x(c + d), if the letter claims `additive`
  double reversibility_defect =
      0.0;  ///< reversibility defect of R x(c) R x(c), if the letter claims `reversible`

  /// Tolerance of central differences, which keep two thirds of the digits, with a factor for their third
  /// derivative.
  static constexpr double slope_tolerance = 1e-6;

  /// Whether everything is finite and each claim holds to the tolerance.
  bool passed() const;
  /// The first claim that does not hold, in the order in which mistakes cause others.
  std::string report() const;
};

namespace detail {

/// What one letter did from one point x = (q, p): columns of 2 N numbers.
struct letter_trial {
  Eigen::VectorXd x;           ///< where it began
  Eigen::VectorXd y;           ///< where it led
  Eigen::MatrixXd jacobian;    ///< of y by x
  Eigen::VectorXd back;        ///< y after the negated coefficients
  Eigen::VectorXd in_parts;    ///< x after 0.4 and 0.6 of the coefficients
  Eigen::VectorXd reversed;    ///< R x(c) R x(c)
  Eigen::VectorXd slope;       ///< of y by a common factor of the coefficients, by dual numbers
  Eigen::VectorXd difference;  ///< the same by a central difference
};

/// What a letter claims.
struct letter_claims {
  char letter;
  bool moves_q;
  bool symplectic;
  bool invertible;
  bool additive;
  bool reversible;
};

letter_check judge_letter(const letter_claims& claims, const std::vector<letter_trial>& trials);

}  // namespace detail

}  // namespace nysalt
