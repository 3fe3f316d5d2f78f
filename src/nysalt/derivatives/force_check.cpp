// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/force_check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace nysalt {

namespace {

std::string where(Eigen::Index coordinate) {
  return coordinate < 0 ? "along a direction at random it" : fmt::format("coordinate {}", coordinate + 1);
}

}  // namespace

std::string force_check::report() const {
  if (passed()) return fmt::format("the force is {}", has_potential ? "-grad V" : "conservative");
  if (!passes_beside) return objection();
  return objection() +
         "; a little beside these points nothing is wrong, as where there is a kink or a pole at one of them";
}

std::string force_check::objection() const {
  if (!finite) return "the force or velocity is not finite at one of the points, or not differentiable there";
  if (gradient_defect > tolerance) {
    return fmt::format(
        "the force is not -grad V: {} is off by {:.2e} of the largest force; check its sign and formula",
        where(coordinate), gradient_defect);
  }
  if (kick_defect > kick_tolerance) {
    return fmt::format(
        "the kick is not p += c force(q): {} is off by {:.2e} of the largest force; check its formula, or "
        "leave it out",
        where(kick_coordinate), kick_defect);
  }
  if (range_defect > kick_tolerance) {
    if (!std::isfinite(range_defect)) {
      return fmt::format(
          "force_in_range reads sites beyond reach() from the range: {} is not finite where these are not; "
          "check reach() and the formula",
          where(range_coordinate));
    }
    return fmt::format(
        "force_in_range or kick_in_range is not the force: {} is off by {:.2e} of the largest force; check "
        "its "
        "formula at the ends of ranges",
        where(range_coordinate), range_defect);
  }
  if (soft_defect > kick_tolerance) {
    return fmt::format(
        "the soft_force is not the force without the quadratic part that modes() declares: {} is off by "
        "{:.2e} of the largest force; check both",
        where(soft_coordinate), soft_defect);
  }
  if (derivative_defect > derivative_tolerance) {
    return fmt::format(
        "force_derivative is not f'(q) v: it is off by {:.2e} of the largest entry of f'; check its sign "
        "and formula, or leave it out",
        derivative_defect);
  }
  if (asymmetry > asymmetry_tolerance) {
    return fmt::format("the force is not conservative: its Jacobian is asymmetric by {:.2e}", asymmetry);
  }
  if (velocity_defect > velocity_tolerance) {
    return fmt::format(
        "the velocity is not grad K: {} is off by {:.2e} of the largest velocity; check its sign and "
        "formula",
        where(velocity_coordinate), velocity_defect);
  }
  return fmt::format("the velocity is not the gradient of any K: its Jacobian is asymmetric by {:.2e}",
                     velocity_asymmetry);
}

}  // namespace nysalt
