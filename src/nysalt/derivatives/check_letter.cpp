// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/check_letter.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <limits>

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

double symplecticity_defect(const Eigen::MatrixXd& j) {
  const Eigen::Index n = j.rows() / 2;
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  omega.topRightCorner(n, n).setIdentity();
  omega.bottomLeftCorner(n, n).diagonal().setConstant(-1.0);
  const Eigen::ArrayXXd defect = (j.transpose() * omega * j - omega).array().abs();
  const Eigen::MatrixXd size = j.cwiseAbs().transpose() * omega.cwiseAbs() * j.cwiseAbs() + omega.cwiseAbs();
  return (size.array() > 0.0).select(defect / size.array(), 0.0).maxCoeff();
}

bool is_finite(const letter_trial& t) {
  return t.y.allFinite() && t.jacobian.allFinite() && t.back.allFinite() && t.in_parts.allFinite() &&
         t.reversed.allFinite() && t.slope.allFinite();
}

}  // namespace

letter_check judge_letter(const letter_claims& claims, const std::vector<letter_trial>& trials) {
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

}  // namespace detail

}  // namespace nysalt
