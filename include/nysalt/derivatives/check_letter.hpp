// SPDX-License-Identifier: BSL-1.0
// A check of letters that users write by hand.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/derivatives/properties.hpp"
#include "nysalt/detail/sentence.hpp"
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

// A check of letters that users write by hand.

namespace detail {

template <Flow L>
constexpr letter_claims claims_of() {
  letter_claims result{L::letter, L::moves_q, is_symplectic<L>(), false, L::additive, true};
  if constexpr (requires { L::invertible; }) result.invertible = L::invertible;
  if constexpr (requires { L::reversible; }) result.reversible = L::reversible;
  return result;
}

/// The letter with all of its coefficients times c.
template <Flow L, System S, Scalar C, Scalar T>
phase_point<T, S::dimension> after_letter(const S& system, const std::vector<double>& coefficients,
                                          const C& c, double h, phase_point<T, S::dimension> x) {
  typename word<L>::template coefficients<C> scaled;
  for (std::size_t k = 0; k < scaled.size(); ++k) scaled[k] = c * coefficients[k];
  stepper<S, word<L>, C>(system, scaled, h).step(x);
  return x;
}

template <int N>
Eigen::VectorXd as_column(const phase_point<double, N>& x) {
  Eigen::VectorXd result(2 * x.size());
  result << x.q, x.p;
  return result;
}

template <Flow L, System S>
letter_trial try_letter(const S& system, const phase_point<double, S::dimension>& x, double h,
                        const std::vector<double>& coefficients) {
  using D = dual<double, 1>;
  constexpr int N = S::dimension;
  const auto after = [&](double c, const phase_point<double, N>& from) {
    return after_letter<L>(system, coefficients, c, h, from);
  };
  const auto turned = [](phase_point<double, N> z) {
    z.p = (-z.p).eval();
    return z;
  };
  letter_trial result;
  const auto y = after(1.0, x);
  result.x = as_column(x);
  result.y = as_column(y);
  result.jacobian = jacobian([&](auto& z) { z = after_letter<L>(system, coefficients, 1.0, h, z); }, x);
  result.back = as_column(after(-1.0, y));
  result.in_parts = as_column(after(0.6, after(0.4, x)));
  result.reversed = as_column(turned(after(1.0, turned(y))));
  constexpr double apart = 6e-6;  // the cube root of a rounding: its square and rounding over it are equal
  result.difference = (as_column(after(1.0 + apart, x)) - as_column(after(1.0 - apart, x))) / (2.0 * apart);
  const auto lifted = after_letter<L>(system, coefficients, D::variable(1.0, 0), h, x.template cast<D>());
  result.slope.resize(result.y.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    result.slope[i] = lifted.q[i].derivative[0];
    result.slope[x.size() + i] = lifted.p[i].derivative[0];
  }
  return result;
}

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
letter_check check_letter(const S& system, const std::vector<phase_point<double, S::dimension>>& points,
                          double h, std::vector<double> coefficients = {}) {
  if (points.empty()) throw std::invalid_argument("check_letter: the points must not be empty");
  if (coefficients.empty()) coefficients.assign(L::slots, 1.0);
  if (coefficients.size() != L::slots) {
    throw std::invalid_argument(sentence("check_letter: coefficients of the letter {} must be {}, got {}",
                                         L::letter, L::slots, coefficients.size()));
  }
  std::vector<detail::letter_trial> trials;
  for (const auto& x : points) trials.push_back(detail::try_letter<L>(system, x, h, coefficients));
  return detail::judge_letter(detail::claims_of<L>(), trials);
}

/// Throws std::invalid_argument, with the report, if a user's letter in this word fails check_letter().
template <TypeLevelWord W, System S>
void require_sound_letters(const S& system, const std::vector<phase_point<double, S::dimension>>& points,
                           double h) {
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
