// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/check_letter.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "nysalt/derivatives/properties.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/stepping/served_letters.hpp"

namespace nysalt {

bool letter_check::passed() const {
  return finite && keeps_q && slope_defect <= slope_tolerance && symplecticity_defect <= tolerance &&
         inverse_defect <= tolerance && additivity_defect <= tolerance && reversibility_defect <= tolerance;
}

std::string letter_check::report() const {
  const auto off = [&](const char* what, double by) {
    return fmt::format("the letter {} is not {}: it is off by {:.2e}; ", letter, what, by);
  };
  if (!finite)
    return fmt::format("the letter {} is not finite, or has no finite derivatives, at a point", letter);
  if (!keeps_q) return fmt::format("the letter {} moves q, but states moves_q = false; say true", letter);
  if (symplecticity_defect > tolerance) {
    return off("symplectic", symplecticity_defect) + "check its formula, or state symplectic = false";
  }
  if (inverse_defect > tolerance) {
    return off("taken back by negated coefficients", inverse_defect) +
           "check its formula, or state invertible = false";
  }
  if (additivity_defect > tolerance) {
    return off("additive", additivity_defect) +
           "the flow over c and then d must be that over c + d; check it, or state additive = false";
  }
  if (reversibility_defect > tolerance) {
    return off("reversible", reversibility_defect) + "check its formula, or state reversible = false";
  }
  if (slope_defect > slope_tolerance) {
    return fmt::format(
        "the letter {} has a derivative by its coefficients that is off by {:.2e} of a difference; write it "
        "over any scalar, and iterate once more after the value has converged",
        letter, slope_defect);
  }
  return fmt::format("the letter {} is what it states", letter);
}

namespace {

using state = phase_point<double, Eigen::Dynamic>;
using detail::slopes;

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

Eigen::VectorXd as_column(const state& x) {
  Eigen::VectorXd result(2 * x.size());
  result << x.q, x.p;
  return result;
}

/// A letter with its coefficients on a system.
class tried_letter {
 public:
  tried_letter(const model& system, const word& letter, std::vector<double> coefficients, double h)
      : system_(system), letter_(letter), coefficients_(std::move(coefficients)), h_(h) {}

  letter_trial from(const state& x) const {
    const auto turned = [](state z) {
      z.p = (-z.p).eval();
      return z;
    };
    letter_trial result;
    const state y = after(1.0, x);
    result.x = as_column(x);
    result.y = as_column(y);
    result.jacobian = jacobian_at(x);
    result.back = as_column(after(-1.0, y));
    result.in_parts = as_column(after(0.6, after(0.4, x)));
    result.reversed = as_column(turned(after(1.0, turned(y))));
    constexpr double apart = 6e-6;  // the cube root of a rounding: its square and rounding over it are equal
    result.difference = (as_column(after(1.0 + apart, x)) - as_column(after(1.0 - apart, x))) / (2.0 * apart);
    result.slope = slope_at(x);
    return result;
  }

 private:
  /// All coefficients times c.
  state after(double c, state x) const {
    std::vector<double> scaled = coefficients_;
    for (double& one : scaled) one *= c;
    stepper<model>(system_, letter_, scaled, h_).step(x);
    return x;
  }
  phase_point<slopes, Eigen::Dynamic> after_with_slopes(const slopes& c,
                                                        phase_point<slopes, Eigen::Dynamic> x) const {
    std::vector<slopes> scaled;
    for (const double one : coefficients_) scaled.push_back(c * one);
    stepper<model, slopes>(system_, letter_, scaled, h_).step(x);
    return x;
  }
  static Eigen::VectorXd derivative_of(const phase_point<slopes, Eigen::Dynamic>& x, std::size_t k) {
    Eigen::VectorXd result(2 * x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      result[i] = x.q[i].derivative[k];
      result[x.size() + i] = x.p[i].derivative[k];
    }
    return result;
  }
  Eigen::VectorXd slope_at(const state& x) const {
    return derivative_of(after_with_slopes(slopes::variable(1.0, 0), x.template cast<slopes>()), 0);
  }
  /// Columns q, then p, two at a time.
  Eigen::MatrixXd jacobian_at(const state& x) const {
    const Eigen::Index n = x.size();
    Eigen::MatrixXd result(2 * n, 2 * n);
    for (Eigen::Index column = 0; column < 2 * n; column += 2) {
      auto y = x.template cast<slopes>();
      for (Eigen::Index k = column; k < column + 2; ++k) {
        (k < n ? y.q[k] : y.p[k - n]).derivative[static_cast<std::size_t>(k - column)] = 1.0;
      }
      y = after_with_slopes(slopes(1.0), y);
      for (Eigen::Index k = column; k < column + 2; ++k) {
        result.col(k) = derivative_of(y, static_cast<std::size_t>(k - column));
      }
    }
    return result;
  }

  const model& system_;
  const word& letter_;
  std::vector<double> coefficients_;
  double h_;
};

/// Largest |a - b| by coordinate, in units of the coordinate.
double off(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& unit) {
  return ((a - b).array().abs() / unit.array()).maxCoeff();
}

double symplecticity_defect(const Eigen::MatrixXd& j) {
  const Eigen::Index n = j.rows() / 2;
  const Eigen::MatrixXd omega = detail::symplectic_form(n);
  const Eigen::ArrayXXd defect = (j.transpose() * omega * j - omega).array().abs();
  const Eigen::MatrixXd size = j.cwiseAbs().transpose() * omega.cwiseAbs() * j.cwiseAbs() + omega.cwiseAbs();
  return (size.array() > 0.0).select(defect / size.array(), 0.0).maxCoeff();
}

bool is_finite(const letter_trial& t) {
  return t.y.allFinite() && t.jacobian.allFinite() && t.back.allFinite() && t.in_parts.allFinite() &&
         t.reversed.allFinite() && t.slope.allFinite();
}

letter_check judge_letter(const letter_facts& claims, const std::vector<letter_trial>& trials) {
  letter_check result{.letter = claims.letter};
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(trials.front().x.size());
  Eigen::VectorXd unit_of_slope = unit;
  for (const auto& t : trials) {
    if (!is_finite(t)) result.finite = false;
    unit = unit.cwiseMax(t.x.cwiseAbs()).cwiseMax(t.y.cwiseAbs());
    unit_of_slope = unit_of_slope.cwiseMax(t.difference.cwiseAbs());
  }
  if (!result.finite) return result;
  // What is zero at all points has no unit of its own.
  const double largest = std::max(unit.maxCoeff(), std::numeric_limits<double>::min());
  for (double& x : unit) x = x > 0.0 ? x : largest;
  // The difference is no better than rounding of the state.
  unit_of_slope = unit_of_slope.cwiseMax(1e-3 * unit);
  for (const auto& t : trials) {
    const Eigen::Index n = t.x.size() / 2;
    if (!claims.moves_q && t.x.head(n) != t.y.head(n)) result.keeps_q = false;
    const auto keep = [](double& worst, double found) { worst = std::max(worst, found); };
    if (claims.symplectic) keep(result.symplecticity_defect, symplecticity_defect(t.jacobian));
    if (claims.invertible) keep(result.inverse_defect, off(t.back, t.x, unit));
    if (claims.additive) keep(result.additivity_defect, off(t.in_parts, t.y, unit));
    if (claims.reversible) keep(result.reversibility_defect, off(t.reversed, t.x, unit));
    keep(result.slope_defect, off(t.slope, t.difference, unit_of_slope));
  }
  return result;
}

}  // namespace

letter_check check_letter(const model& system, char letter, const phase_points& points, double h,
                          std::vector<double> coefficients) {
  const word letters(std::string_view(&letter, 1), system.facts().own_letters);
  require_served<model, double>(letters, system);
  if (points.empty()) throw std::invalid_argument("check_letter: the points must not be empty");
  if (coefficients.empty()) coefficients.assign(letters.slots, 1.0);
  if (coefficients.size() != letters.slots) {
    throw std::invalid_argument(fmt::format("check_letter: coefficients of the letter {} must be {}, got {}",
                                            letter, letters.slots, coefficients.size()));
  }
  const tried_letter tried(system, letters, std::move(coefficients), h);
  std::vector<letter_trial> trials;
  for (const auto& x : points) trials.push_back(tried.from(x));
  return judge_letter(letters.facts(0), trials);
}

void detail::require_sound_letters(const model& system, const word& letters, const phase_points& points,
                                   double h) {
  for (const letter_facts& own : letters.own()) {
    const letter_check found = check_letter(system, own.letter, points, h);
    if (!found.passed()) throw std::invalid_argument(found.report());
  }
}

}  // namespace nysalt
