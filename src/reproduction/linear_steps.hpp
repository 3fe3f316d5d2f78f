// SPDX-License-Identifier: BSL-1.0
// One step of the damped oscillator dq = p dt, dp = (-Omega q - gamma p) dt as a matrix: exactly, and by the
// two-stage scheme as the paper writes it.
#pragma once

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <functional>

namespace nysalt::program::paper {

using two_parameters = std::array<double, 2>;  // b1, beta1

/// e^{A h} = e^{-gamma h/2} (cos(nu h) 1 + sin(nu h)/nu (A + gamma/2 1)), nu^2 = Omega - gamma^2/4 > 0.
inline Eigen::Matrix2d exact_step(double h, double Omega, double gamma) {
  const double nu = std::sqrt(Omega - 0.25 * gamma * gamma);
  Eigen::Matrix2d A;
  A << 0.5 * gamma, 1.0, -Omega, -0.5 * gamma;
  return std::exp(-0.5 * gamma * h) *
         (std::cos(nu * h) * Eigen::Matrix2d::Identity() + std::sin(nu * h) / nu * A);
}

/// The scheme (2.7-8) on the unit vectors. beta1 + beta2 is 1/2, and 1 as the proposition prints it.
inline Eigen::Matrix2d one_step(const two_parameters& theta, double h, double Omega, double beta_sum = 0.5) {
  const auto [b1, beta1] = theta;
  const double b2 = 1.0 - b1;
  const double beta2 = beta_sum - beta1;
  const double c1 = 1.0 - beta1 / b1;
  const double c2 = 1.0 - beta2 / b2;
  const double a21 = b1 * (c2 - c1);
  Eigen::Matrix2d result;
  for (const int column : {0, 1}) {
    const double q = column == 0 ? 1.0 : 0.0;
    const double p = column == 0 ? 0.0 : 1.0;
    const double l1 = -Omega * (q + h * c1 * p);
    const double l2 = -Omega * (q + h * c2 * p + h * h * a21 * l1);
    result(0, column) = q + h * p + h * h * (beta1 * l1 + beta2 * l2);
    result(1, column) = p + h * (b1 * l1 + b2 * l2);
  }
  return result;
}

/// Newton's method with differences of five points, which are exact for the leading part of every loss here,
/// a polynomial of the fourth degree; halved while it leads uphill.
inline two_parameters minimum_near(const two_parameters& start,
                                   const std::function<double(const two_parameters&)>& loss) {
  constexpr double d = 1e-3;
  Eigen::Vector2d x(start[0], start[1]);
  const auto at = [&](const Eigen::Vector2d& y) { return loss({y[0], y[1]}); };
  const auto slope_along = [&](const Eigen::Vector2d& y, int i) {
    const Eigen::Vector2d e = d * Eigen::Vector2d::Unit(i);
    return (8.0 * (at(y + e) - at(y - e)) - (at(y + 2.0 * e) - at(y - 2.0 * e))) / (12.0 * d);
  };
  for (int n = 0; n < 100; ++n) {
    Eigen::Vector2d gradient;
    Eigen::Matrix2d hessian;
    for (const int i : {0, 1}) {
      gradient[i] = slope_along(x, i);
      for (const int k : {0, 1}) {
        const Eigen::Vector2d e = d * Eigen::Vector2d::Unit(k);
        hessian(i, k) = (slope_along(x + e, i) - slope_along(x - e, i)) / (2.0 * d);
      }
    }
    const Eigen::Matrix2d symmetric = 0.5 * (hessian + hessian.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(symmetric);
    const Eigen::Vector2d curvature = axes.eigenvalues().cwiseAbs();
    Eigen::Vector2d change =
        -axes.eigenvectors() * (axes.eigenvectors().transpose() * gradient).cwiseQuotient(curvature);
    if (change.norm() > 0.05) change *= 0.05 / change.norm();
    for (int halvings = 0; halvings < 10 && at(x + change) > at(x); ++halvings) change *= 0.5;
    x += change;
    if (change.norm() < 1e-10) break;
  }
  return {x[0], x[1]};
}

}  // namespace nysalt::program::paper
