// SPDX-License-Identifier: BSL-1.0
// A check of letters that users write by hand.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/stepper.hpp"

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

/// A letter over a step on a system: what it claims, and what it does.
struct letter_to_check {
  /// A state, q over p, after the letter with all of its coefficients times c.
  template <class T>
  using map = std::function<vector<T, Eigen::Dynamic>(const vector<T, Eigen::Dynamic>& x, const T& c)>;

  char letter;
  bool moves_q;
  bool symplectic;
  bool invertible;
  bool additive;
  bool reversible;
  map<double> over_double;
  map<dual<double, 1>> over_dual;
};

letter_check judge_letter(const letter_to_check& letter, const phase_points& points);

}  // namespace detail

/// Test of the declared properties of a letter, of the user or the library, over the step h at some points:
/// that it is symplectic (by its exact Jacobian), that negated coefficients take it back, that coefficients
/// add up, that it is reversible, that it leaves q unchanged; and the derivative by its coefficients, which
/// learning needs, with a difference. The coefficients are 1 unless given. Points should be typical of the
/// motion: two or more show the unit of each coordinate.
///
/// Throws std::invalid_argument if there are no points, if one has not the system's dimension, or unless
/// there is a coefficient for each slot. Cost: 2 N + 8 letters a point, most over dual numbers.
template <Flow L, System S>
  requires(!StochasticFlow<L>)
letter_check check_letter(const S& system, const phase_points& points, double h,
                          std::vector<double> coefficients = {}) {
  if (points.empty()) throw std::invalid_argument("check_letter: the points must not be empty");
  if (coefficients.empty()) coefficients.assign(L::slots, 1.0);
  if (coefficients.size() != L::slots) {
    throw std::invalid_argument(sentence("check_letter: coefficients of the letter {} must be {}, got {}",
                                         L::letter, L::slots, coefficients.size()));
  }
  const auto after = [&]<class T>(const vector<T, Eigen::Dynamic>& x, const T& c) {
    const Eigen::Index n = x.size() / 2;
    typename word<L>::template coefficients<T> scaled;
    for (std::size_t k = 0; k < scaled.size(); ++k) scaled[k] = c * coefficients[k];
    phase_point<T, S::dimension> y{x.head(n), x.tail(n)};
    stepper<S, word<L>, T>(system, scaled, h).step(y);
    vector<T, Eigen::Dynamic> result(2 * n);
    result << y.q, y.p;
    return result;
  };
  detail::letter_to_check letter{L::letter, L::moves_q, detail::is_symplectic<L>(), false, L::additive, true,
                                 after,     after};
  if constexpr (requires { L::invertible; }) letter.invertible = L::invertible;
  if constexpr (requires { L::reversible; }) letter.reversible = L::reversible;
  return detail::judge_letter(letter, points);
}

/// Throws std::invalid_argument, with the report, if a user's letter in this word fails check_letter().
template <TypeLevelWord W, System S>
void require_sound_letters(const S& system, const phase_points& points, double h) {
  const auto require_one = [&]<class L>(std::type_identity<L>) {
    if constexpr (!detail::is_known_letter<L>) {
      const letter_check found = check_letter<L>(system, points, h);
      if (!found.passed()) throw std::invalid_argument(found.report());
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (require_one(std::type_identity<typename W::template letter<I>>()), ...);
  }(std::make_index_sequence<W::length>());
}

}  // namespace nysalt
