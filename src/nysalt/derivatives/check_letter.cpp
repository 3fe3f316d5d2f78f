// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/check_letter.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include <vector>

#include "nysalt/derivatives/properties.hpp"

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

namespace detail {

namespace {

/// Largest |a - b| by coordinate, in units of the coordinate.
double off(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& unit) {
  return ((a - b).array().abs() / unit.array()).maxCoeff();
}

/// What a letter did from one point: columns of 2 N numbers.
struct letter_trial {
  Eigen::VectorXd x;           // where it began
  Eigen::VectorXd y;           // where it led
  Eigen::MatrixXd jacobian;    // of y by x
  Eigen::VectorXd back;        // y after the negated coefficients
  Eigen::VectorXd in_parts;    // x after 0.4 and 0.6 of the coefficients
  Eigen::VectorXd reversed;    // R x(c) R x(c)
  Eigen::VectorXd slope;       // of y by a common factor of the coefficients, by dual numbers
  Eigen::VectorXd difference;  // the same by a central difference

  letter_trial(const letter_to_check& letter, const Eigen::VectorXd& point)
      : x(point), y(letter.over_double(x, 1.0)), jacobian(x.size(), x.size()) {
    using D = dual<double, 1>;
    vector<D, Eigen::Dynamic> lifted(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) lifted[i] = D(x[i]);
    const auto slopes_of = [&](const vector<D, Eigen::Dynamic>& from, const D& c) {
      const auto to = letter.over_dual(from, c);
      return Eigen::VectorXd::NullaryExpr(to.size(), [&](Eigen::Index i) { return to[i].derivative[0]; })
          .eval();
    };
    for (Eigen::Index column = 0; column < x.size(); ++column) {
      lifted[column].derivative[0] = 1.0;
      jacobian.col(column) = slopes_of(lifted, D(1.0));
      lifted[column].derivative[0] = 0.0;
    }
    slope = slopes_of(lifted, D::variable(1.0, 0));
    const auto turned = [](Eigen::VectorXd z) {
      z.tail(z.size() / 2) *= -1.0;
      return z;
    };
    back = letter.over_double(y, -1.0);
    in_parts = letter.over_double(letter.over_double(x, 0.4), 0.6);
    reversed = turned(letter.over_double(turned(y), 1.0));
    constexpr double apart = 6e-6;  // the cube root of a rounding: its square and rounding over it are equal
    difference = (letter.over_double(x, 1.0 + apart) - letter.over_double(x, 1.0 - apart)) / (2.0 * apart);
  }

  bool is_finite() const {
    return y.allFinite() && jacobian.allFinite() && back.allFinite() && in_parts.allFinite() &&
           reversed.allFinite() && slope.allFinite();
  }
};

double relative_symplecticity_defect(const Eigen::MatrixXd& j) {
  const Eigen::MatrixXd omega = symplectic_form(j.rows() / 2);
  const Eigen::ArrayXXd defect = (j.transpose() * omega * j - omega).array().abs();
  const Eigen::MatrixXd size = j.cwiseAbs().transpose() * omega.cwiseAbs() * j.cwiseAbs() + omega.cwiseAbs();
  return (size.array() > 0.0).select(defect / size.array(), 0.0).maxCoeff();
}

}  // namespace

letter_check judge_letter(const letter_to_check& letter, const phase_points& points) {
  letter_check result{.letter = letter.letter};
  std::vector<letter_trial> trials;
  for (const auto& point : points) {
    Eigen::VectorXd x(2 * point.size());
    x << point.q, point.p;
    trials.emplace_back(letter, x);
  }
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(trials.front().x.size());
  Eigen::VectorXd unit_of_slope = unit;
  for (const auto& t : trials) {
    if (!t.is_finite()) result.finite = false;
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
    if (!letter.moves_q && t.x.head(n) != t.y.head(n)) result.keeps_q = false;
    const auto keep = [](double& worst, double found) { worst = std::max(worst, found); };
    if (letter.symplectic) keep(result.symplecticity_defect, relative_symplecticity_defect(t.jacobian));
    if (letter.invertible) keep(result.inverse_defect, off(t.back, t.x, unit));
    if (letter.additive) keep(result.additivity_defect, off(t.in_parts, t.y, unit));
    if (letter.reversible) keep(result.reversibility_defect, off(t.reversed, t.x, unit));
    keep(result.slope_defect, off(t.slope, t.difference, unit_of_slope));
  }
  return result;
}

}  // namespace detail

}  // namespace nysalt
