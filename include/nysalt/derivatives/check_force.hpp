// SPDX-License-Identifier: BSL-1.0
// A check of what users write by hand.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/derivatives/differences.hpp"
#include "nysalt/energy.hpp"

namespace nysalt {

/// Defects are relative to the largest entry, over all points, of what they are a defect of: of the force, of
/// its Jacobian, of the velocity, of its Jacobian. They are 0 where there is nothing to compare.
struct force_check {
  double gradient_defect = 0.0;      // of force = -grad V
  Eigen::Index coordinate = 0;       // where that is worst, from 0
  double derivative_defect = 0.0;    // of force_derivative, against differences of the force
  double kick_defect = 0.0;          // of a kick of the system's own, p += c force(q)
  Eigen::Index kick_coordinate = 0;  // where that is worst
  double asymmetry = 0.0;            // of the Jacobian of the force: a gradient's is symmetric
  double velocity_defect = 0.0;      // of velocity = grad K
  Eigen::Index velocity_coordinate = 0;
  double velocity_asymmetry = 0.0;  // of the Jacobian of a velocity without a kinetic energy
  double tolerance = 0.0;           // what the derivatives used can be off by: of gradient and asymmetry
  double kick_tolerance = 0.0;
  double derivative_tolerance = 0.0;
  double velocity_tolerance = 0.0;
  bool has_potential = false;
  bool finite = true;  // all functions and their derivatives, at all points

  bool passed() const {
    return finite && gradient_defect <= tolerance && kick_defect <= kick_tolerance &&
           derivative_defect <= derivative_tolerance && asymmetry <= tolerance &&
           velocity_defect <= velocity_tolerance && velocity_asymmetry <= velocity_tolerance;
  }
  /// The first thing that is wrong, in the order in which mistakes cause others.
  std::string report() const {
    if (passed()) return fmt::format("the force is {}", has_potential ? "-grad V" : "conservative");
    if (!finite)
      return "the force or velocity is not finite at one of the points, or not differentiable there";
    if (gradient_defect > tolerance) {
      return fmt::format(
          "the force is not -grad V: coordinate {} is off by {:.2e} of the largest force; check its "
          "sign and formula",
          coordinate + 1, gradient_defect);
    }
    if (kick_defect > kick_tolerance) {
      return fmt::format(
          "the kick is not p += c force(q): coordinate {} is off by {:.2e} of the largest force; check its "
          "formula, or leave it out",
          kick_coordinate + 1, kick_defect);
    }
    if (derivative_defect > derivative_tolerance) {
      return fmt::format(
          "force_derivative is not f'(q) v: it is off by {:.2e} of the largest entry of f'; check its sign "
          "and formula, or leave it out",
          derivative_defect);
    }
    if (asymmetry > tolerance) {
      return fmt::format("the force is not conservative: its Jacobian is asymmetric by {:.2e}", asymmetry);
    }
    if (velocity_defect > velocity_tolerance) {
      return fmt::format(
          "the velocity is not grad K: coordinate {} is off by {:.2e} of the largest velocity; check its "
          "sign and formula",
          velocity_coordinate + 1, velocity_defect);
    }
    return fmt::format("the velocity is not the gradient of any K: its Jacobian is asymmetric by {:.2e}",
                       velocity_asymmetry);
  }
};

namespace detail {

/// Exact derivatives of a formula of a hundred operations, whose terms exceed their sum up to 7e5 times, err
/// by less than 100 * 7e5 eps = sqrt(eps) of it.
inline double tolerance_of_exact() { return std::sqrt(std::numeric_limits<double>::epsilon()); }
/// The Jacobian of map(x, result), which is given over dual numbers.
template <int N>
Eigen::MatrixXd dual_jacobian(const auto& map, const vector<double, N>& x) {
  const Eigen::Index n = x.size();
  vector<dual<double, 1>, N> lifted(n);
  vector<dual<double, 1>, N> y(n);
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) lifted[i] = x[i];
    lifted[j].derivative[0] = 1.0;
    map(lifted, y);
    for (Eigen::Index i = 0; i < n; ++i) result(i, j) = y[i].derivative[0];
  }
  return result;
}

inline double largest_entry(const auto& a) { return a.cwiseAbs().maxCoeff(); }
inline double asymmetry_of(const Eigen::MatrixXd& a) { return largest_entry(a - a.transpose()); }

}  // namespace detail

/// Compares force with -grad V, kick with force, and force_derivative with differences of the force, and
/// looks at the symmetry of f'(q), at the given points; at the same numbers as momenta compares a velocity of
/// the system's own with grad K, or looks at the symmetry of its Jacobian. Derivatives are automatic where
/// the system allows, else central differences. Cost: some N forces and potentials a point. Throws
/// std::invalid_argument if there are no points or one has not the system's dimension.
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points) {
  constexpr int N = S::dimension;
  constexpr bool differentiable = HasPotential<S, dual<double, detail::sweep<N>>>;
  constexpr bool differentiable_kinetic = HasKineticEnergy<S, dual<double, detail::sweep<N>>>;
  constexpr bool differentiable_velocity = HasVelocity<S, dual<double, 1>>;
  const Eigen::Index n = size(system);
  if (points.empty()) throw std::invalid_argument("check_force: no points to check at; give it one or more");
  for (std::size_t m = 0; m < points.size(); ++m) {
    if (points[m].size() == n) continue;
    throw std::invalid_argument(
        fmt::format("check_force: point {} has {} coordinates, the system {}", m + 1, points[m].size(), n));
  }

  const double of_exact = detail::tolerance_of_exact();
  const double of_differences = detail::tolerance_of_differences();
  force_check result;
  result.has_potential = HasPotential<S, double>;
  result.tolerance = BlackBoxForce<S> || !differentiable ? of_differences : of_exact;
  result.kick_tolerance = of_exact;
  result.derivative_tolerance = of_differences;
  constexpr bool exact_velocity =
      HasKineticEnergy<S, double> ? differentiable_kinetic : differentiable_velocity;
  result.velocity_tolerance = exact_velocity ? of_exact : of_differences;

  double largest_force = std::numeric_limits<double>::min();
  double largest_slope = largest_force;
  double largest_velocity = largest_force;
  double largest_velocity_slope = largest_force;
  auto f = make_vector<double>(system);
  auto expected = f;
  const auto note = [&](const auto& defects, double& largest, Eigen::Index& coordinate) {
    Eigen::Index worst = 0;
    const double defect = defects.cwiseAbs().maxCoeff(&worst);
    if (defect <= largest) return;
    largest = defect;
    coordinate = worst;
  };
  for (const auto& q : points) {
    force<double>(system, q, f);
    result.finite = result.finite && f.allFinite();
    largest_force = std::max(largest_force, detail::largest_entry(f));
    if constexpr (HasPotential<S, double>) {
      const auto potential = [&](const auto& x) { return system.potential(x); };
      if constexpr (differentiable) {
        gradient<double, N>(potential, q, -1.0, expected);
      } else {
        for (Eigen::Index i = 0; i < n; ++i) expected[i] = -detail::central_difference<N>(potential, q, i);
      }
      result.finite = result.finite && expected.allFinite();
      note(f - expected, result.gradient_defect, result.coordinate);
    }

    if constexpr (HasKick<S, double>) {
      auto p = f;
      system.kick(q, p, 0.5);
      result.finite = result.finite && p.allFinite();
      note(p - 1.5 * f, result.kick_defect, result.kick_coordinate);
    }

    const Eigen::MatrixXd slopes =
        detail::dual_jacobian<N>([&](const auto& x, auto& y) { force<dual<double, 1>>(system, x, y); }, q);
    result.finite = result.finite && slopes.allFinite();
    largest_slope = std::max(largest_slope, detail::largest_entry(slopes));
    result.asymmetry = std::max(result.asymmetry, detail::asymmetry_of(slopes));
    if constexpr (HasForceDerivative<S>) {
      const auto force_at = [&](const auto& x) {
        auto y = x;
        force<double>(system, x, y);
        return y;
      };
      const Eigen::MatrixXd differences = detail::difference_jacobian<N>(force_at, q);
      Eigen::MatrixXd own(n, n);
      for (Eigen::Index j = 0; j < n; ++j) {
        const vector<double, N> direction = vector<double, N>::Unit(n, j);
        system.force_derivative(q, direction, expected);
        own.col(j) = expected;
      }
      result.finite = result.finite && own.allFinite() && differences.allFinite();
      largest_slope =
          std::max({largest_slope, detail::largest_entry(own), detail::largest_entry(differences)});
      result.derivative_defect = std::max(result.derivative_defect, detail::largest_entry(own - differences));
    }

    if constexpr (HasVelocity<S, double>) {
      const auto velocity_at = [&](const auto& p) {
        auto v = p;
        system.velocity(p, v);
        return v;
      };
      const vector<double, N> v = velocity_at(q);
      result.finite = result.finite && v.allFinite();
      largest_velocity = std::max(largest_velocity, detail::largest_entry(v));
      if constexpr (HasKineticEnergy<S, double>) {
        const auto kinetic = [&](const auto& p) { return system.kinetic_energy(p); };
        if constexpr (differentiable_kinetic) {
          gradient<double, N>(kinetic, q, 1.0, expected);
        } else {
          for (Eigen::Index i = 0; i < n; ++i) expected[i] = detail::central_difference<N>(kinetic, q, i);
        }
        result.finite = result.finite && expected.allFinite();
        note(v - expected, result.velocity_defect, result.velocity_coordinate);
      } else {
        Eigen::MatrixXd rates;
        if constexpr (differentiable_velocity) {
          rates = detail::dual_jacobian<N>([&](const auto& p, auto& y) { system.velocity(p, y); }, q);
        } else {
          rates = detail::difference_jacobian<N>(velocity_at, q);
        }
        result.finite = result.finite && rates.allFinite();
        largest_velocity_slope = std::max(largest_velocity_slope, detail::largest_entry(rates));
        result.velocity_asymmetry = std::max(result.velocity_asymmetry, detail::asymmetry_of(rates));
      }
    }
  }
  result.gradient_defect /= largest_force;
  result.kick_defect /= largest_force;
  result.derivative_defect /= largest_slope;
  result.asymmetry /= largest_slope;
  result.velocity_defect /= largest_velocity;
  result.velocity_asymmetry /= largest_velocity_slope;
  return result;
}

}  // namespace nysalt
