// SPDX-License-Identifier: BSL-1.0
// A check of what users write by hand.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "nysalt/force.hpp"

namespace nysalt {

/// Defects are relative to the largest entry of the force, and of its Jacobian, over all points.
struct force_check {
  double gradient_defect = 0.0;  // of force = -grad V; 0 where the system has no potential
  Eigen::Index coordinate = 0;   // where that is worst, from 0
  double asymmetry = 0.0;        // of the Jacobian of the force: a gradient's is symmetric
  double tolerance = 0.0;        // what the derivatives used can be off by
  bool has_potential = false;
  bool finite = true;  // force, potential and their derivatives, at all points

  bool passed() const { return finite && gradient_defect <= tolerance && asymmetry <= tolerance; }
  std::string report() const {
    if (passed()) return fmt::format("the force is {}", has_potential ? "-grad V" : "conservative");
    if (!finite) return "the force is not finite at one of the points, or not differentiable there";
    if (gradient_defect > tolerance) {
      return fmt::format(
          "the force is not -grad V: coordinate {} is off by {:.2e} of the largest force; check its "
          "sign and formula",
          coordinate + 1, gradient_defect);
    }
    return fmt::format("the force is not conservative: its Jacobian is asymmetric by {:.2e}", asymmetry);
  }
};

/// Compares force with -grad V and looks at the symmetry of f'(q), at the given points. Derivatives are
/// automatic where the system allows, else central differences. Cost: some N forces and potentials a point.
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points) {
  constexpr bool differentiable = HasPotential<S, dual<double, detail::sweep<S::dimension>>>;
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const Eigen::Index n = size(system);
  force_check result;
  result.has_potential = HasPotential<S, double>;
  // Twice the digits that remain: of eps for exact derivatives, of eps^(2/3) for central differences.
  result.tolerance = BlackBoxForce<S> || !differentiable ? 30.0 * std::cbrt(eps) : std::sqrt(eps);

  double largest_force = std::numeric_limits<double>::min();
  double largest_slope = std::numeric_limits<double>::min();
  auto f = make_vector<double>(system);
  auto expected = f;
  Eigen::MatrixXd slopes(n, n);
  for (const auto& q : points) {
    force<double>(system, q, f);
    result.finite = result.finite && f.allFinite();
    largest_force = std::max(largest_force, f.cwiseAbs().maxCoeff());
    if constexpr (HasPotential<S, double>) {
      if constexpr (differentiable) {
        gradient<double, S::dimension>([&](const auto& x) { return system.potential(x); }, q, -1.0, expected);
      } else {
        for (Eigen::Index i = 0; i < n; ++i) {
          const double s = std::cbrt(eps) * std::max(1.0, std::abs(q[i]));
          auto ahead = q;
          auto behind = q;
          ahead[i] += s;
          behind[i] -= s;
          expected[i] = (system.potential(behind) - system.potential(ahead)) / (ahead[i] - behind[i]);
        }
      }
      result.finite = result.finite && expected.allFinite();
      Eigen::Index worst = 0;
      const double defect = (f - expected).cwiseAbs().maxCoeff(&worst);
      if (!(defect <= result.gradient_defect)) {
        result.gradient_defect = defect;
        result.coordinate = worst;
      }
    }
    vector<dual<double, 1>, S::dimension> lifted(n);
    vector<dual<double, 1>, S::dimension> g(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < n; ++i) lifted[i] = q[i];
      lifted[j].derivative[0] = 1.0;
      force<dual<double, 1>>(system, lifted, g);
      for (Eigen::Index i = 0; i < n; ++i) slopes(i, j) = g[i].derivative[0];
    }
    result.finite = result.finite && slopes.allFinite();
    largest_slope = std::max(largest_slope, slopes.cwiseAbs().maxCoeff());
    result.asymmetry = std::max(result.asymmetry, (slopes - slopes.transpose()).cwiseAbs().maxCoeff());
  }
  result.gradient_defect /= largest_force;
  result.asymmetry /= largest_slope;
  return result;
}

}  // namespace nysalt
