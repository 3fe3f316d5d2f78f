// SPDX-License-Identifier: BSL-1.0
// A check of letters that users write by hand.
#pragma once

#include <string>
#include <vector>

#include "nysalt/model.hpp"
#include "nysalt/word.hpp"

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

/// Test of the declared properties of a letter, of the system or the library, over the step h at some points:
/// that it is symplectic (by its exact Jacobian), that negated coefficients take it back, that coefficients
/// add up, that it is reversible, that it leaves q unchanged; and the derivative by its coefficients, which
/// learning needs, with a difference. The coefficients are 1 unless given. Points should be typical of the
/// motion: two or more show the unit of each coordinate.
///
/// Throws std::invalid_argument if the system does not serve the letter, or the letter is O, if there are no
/// points, if one has not the system's dimension, or unless there is a coefficient for each slot. Cost:
/// N + 8 letters a point, most over dual numbers.
letter_check check_letter(const model& system, char letter, const phase_points& points, double h,
                          std::vector<double> coefficients = {});

namespace detail {

/// Throws std::invalid_argument, with the report, if a letter of the system in this word fails
/// check_letter().
void require_sound_letters(const model& system, const word& letters, const phase_points& points, double h);

}  // namespace detail

}  // namespace nysalt
