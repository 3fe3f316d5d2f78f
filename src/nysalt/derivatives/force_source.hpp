// SPDX-License-Identifier: BSL-1.0
// Forces of a model, and derivatives of them by several ways.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/differences.hpp"
#include "nysalt/detail/modal_coordinates.hpp"

namespace nysalt::detail {

/// The force of a model, and derivatives of it: automatic ones, or differences.
class force_source {
 public:
  using column = Eigen::VectorXd;

  explicit force_source(const model& system)
      : size(system.size()),
        has_potential(system.facts().has_potential),
        has_kick(system.facts().has_own_kick),
        has_soft_force(system.facts().has_quadratic_part),
        has_derivative(system.facts().has_own_derivative),
        has_velocity(system.facts().has_own_velocity),
        has_kinetic_energy(system.facts().has_own_kinetic_energy),
        has_exact_potential(system.facts().has_potential_over_slopes && !system.facts().is_black_box),
        has_exact_force(!system.facts().is_black_box),
        has_exact_velocity(has_kinetic_energy ? system.facts().has_kinetic_energy_over_slopes
                                              : system.facts().has_velocity_over_slopes),
        system_(system) {}

  // Which of the functions below there are, and whether slopes are automatic derivatives.
  Eigen::Index size;
  bool has_potential;
  bool has_kick;
  bool has_soft_force;
  bool has_derivative;
  bool has_velocity;
  bool has_kinetic_energy;
  bool has_exact_potential;
  bool has_exact_force;
  bool has_exact_velocity;

  void force(const column& q, column& f) const { system_.force(q, f); }
  /// Of the force along v, which is as long as a displacement of the motion, as all directions are.
  void force_slope(const column& q, const column& v, column& g) const {
    if (system_.facts().is_black_box) {
      column f(q.size());
      system_.force(q, f);
      system_.directional_derivative(q, v, f, g);
    } else {
      vector<slopes, Eigen::Dynamic> result(q.size());
      system_.force(lifted(q, v), result);
      g = first_slopes(result);
    }
  }
  double potential_slope(const column& q, const column& v) const {
    if (system_.facts().has_potential_over_slopes) return system_.potential(lifted(q, v)).derivative[0];
    if (!has_potential) return 0.0;
    return difference_along([&](const column& x) { return system_.potential(x); }, q, v);
  }
  /// p += force(q)/2
  void kick(const column& q, column& p) const { system_.own_kick(q, p, 0.5); }
  void soft_force(const column& q, column& f) const { system_.soft_force(q, f); }
  std::shared_ptr<const modal_coordinates> modes() const { return modal_coordinates::of(system_); }
  void derivative(const column& q, const column& v, column& g) const { system_.force_derivative(q, v, g); }
  void velocity(const column& p, column& v) const { system_.kernels<double>().velocity(p, v); }
  void velocity_slope(const column& p, const column& v, column& g) const {
    if (system_.facts().has_velocity_over_slopes) {
      vector<slopes, Eigen::Dynamic> result(p.size());
      system_.kernels<slopes>().velocity(lifted(p, v), result);
      g = first_slopes(result);
    } else {
      const auto at = [&](const column& x) {
        column result(x.size());
        velocity(x, result);
        return result;
      };
      g = difference_along(at, p, v);
    }
  }
  double kinetic_slope(const column& p, const column& v) const {
    if (system_.facts().has_kinetic_energy_over_slopes) {
      return system_.kernels<slopes>().kinetic_energy(lifted(p, v)).derivative[0];
    }
    const auto at = [&](const column& x) { return system_.kernels<double>().kinetic_energy(x); };
    return has_kinetic_energy ? difference_along(at, p, v) : 0.0;
  }

 private:
  static vector<slopes, Eigen::Dynamic> lifted(const column& x, const column& v) {
    vector<slopes, Eigen::Dynamic> result(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      result[i] = slopes(x[i]);
      result[i].derivative[0] = v[i];
    }
    return result;
  }
  static column first_slopes(const vector<slopes, Eigen::Dynamic>& x) {
    column result(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = x[i].derivative[0];
    return result;
  }

  model system_;
};

/// Exact derivatives of a formula of a hundred operations, whose terms exceed their sum up to 7e5 times, err
/// by less than 100 * 7e5 eps = sqrt(eps) of it.
double tolerance_of_exact() { return std::sqrt(std::numeric_limits<double>::epsilon()); }

}  // namespace nysalt::detail
