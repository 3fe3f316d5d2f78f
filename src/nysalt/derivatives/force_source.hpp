// SPDX-License-Identifier: BSL-1.0
// Forces of a model, and derivatives of them by several ways.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/site_kernels.hpp"

// Derivatives of what cannot be differentiated otherwise.

namespace nysalt::detail {

/// Adapted differences err by 1e-7 of what they differentiate for one that is some r = |V|/(L |f|) = 1 of it,
/// and by r times their rounding, 1e-11: below this for r < 10^7.
inline double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// The derivative of function(vector), a double or a vector, along a direction whose size is that of a
/// displacement of the motion.
auto difference_along(const auto& function, const Eigen::VectorXd& x, const Eigen::VectorXd& direction) {
  using result_type = std::decay_t<decltype(function(x))>;
  const double farthest = farthest_from(x, direction);
  if constexpr (std::is_same_v<result_type, double>) {
    using number = Eigen::Matrix<double, 1, 1>;
    const auto value_at = [&](double s, number& y) { y[0] = function(Eigen::VectorXd(x + s * direction)); };
    const number middle(function(x));
    number result(0.0);
    adapted_difference(value_at, middle, number(1.0), noise_of_forces * std::abs(middle[0]), farthest,
                       result);
    return result[0];
  } else {
    const auto value_at = [&](double s, Eigen::VectorXd& y) {
      y = function(Eigen::VectorXd(x + s * direction));
    };
    const Eigen::VectorXd middle = function(x);
    const double noise = noise_of_forces * direction.cwiseAbs().dot(middle.cwiseAbs());
    Eigen::VectorXd result = x;
    adapted_difference(value_at, middle, direction, noise, farthest, result);
    return result;
  }
}

/// The force of a model, and derivatives of it: automatic ones, or differences.
class force_source {
 public:
  using column = Eigen::VectorXd;

  explicit force_source(const model& system)
      : size(system.size()),
        has_potential(system.facts().has_potential),
        has_kick(system.facts().has_own_kick),
        has_ranges(system.sites() != nullptr),
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
  bool has_ranges;
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
  /// The same in four ranges of sites, by the kick and by the force in turn. What is beyond the reach of a
  /// range is not a number.
  void kick_in_ranges(const column& q, column& p) const {
    const site_kernels& sites = *system_.sites();
    const site_layout layout = sites.layout();
    const Eigen::Index rows = layout.sites / layout.sites_of_row;
    constexpr Eigen::Index ranges = 4;
    for (Eigen::Index k = 0; k < ranges; ++k) {
      kick_in_range(layout.sites_of_row * (rows * k / ranges),
                    layout.sites_of_row * (rows * (k + 1) / ranges), k % 2 == 1, q, p);
    }
  }
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
  void kick_in_range(Eigen::Index begin, Eigen::Index end, bool by_force, const column& q, column& p) const {
    const site_layout layout = system_.sites()->layout();
    const auto is_there = [&](Eigen::Index i) { return layout.is_periodic || (0 <= i && i < layout.sites); };
    Eigen::Index first = begin - layout.reach;
    Eigen::Index last = end + layout.reach;
    if (!is_there(first)) first = 0;
    if (!is_there(last - 1)) last = layout.sites;
    const Eigen::Index margin = 3 * layout.reach + 16;
    const Eigen::Index stride = last - first + 2 * margin;
    std::vector<double> values(static_cast<std::size_t>(3 * layout.components * stride),
                               std::numeric_limits<double>::quiet_NaN());
    const auto part = [&](Eigen::Index number) {
      return columns(values.data() + number * layout.components * stride, first - margin, stride);
    };
    const tile x{
        part(0), part(1), part(2), first, last, first == begin - layout.reach, last == end + layout.reach};
    for (Eigen::Index c = 0; c < layout.components; ++c) {
      for (Eigen::Index i = first; i < last; ++i) {
        const Eigen::Index site = (i % layout.sites + layout.sites) % layout.sites;
        x.q(c, i) = q[layout.components * site + c];
        x.p(c, i) = p[layout.components * site + c];
      }
    }
    const std::array<tile_letter, 1> letter{{{.coefficient = 0.5, .is_kick = true, .keeps_force = by_force}}};
    system_.sites()->advance(x, letter);
    for (Eigen::Index c = 0; c < layout.components; ++c) {
      for (Eigen::Index i = begin; i < end; ++i) p[layout.components * i + c] = x.p(c, i);
    }
  }

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
