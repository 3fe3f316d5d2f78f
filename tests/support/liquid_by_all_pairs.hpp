// SPDX-License-Identifier: BSL-1.0
// A Lennard-Jones liquid by all pairs, with what rounding may do to it.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "nysalt/systems/lennard_jones_liquid.hpp"
#include "rounding.hpp"

namespace nysalt::test {

/// The derivative of 4 (x^-6 - x^-3) of that order.
inline double pair_derivative(double x, int order) {
  const double third = 1.0 / (x * x * x);
  double of_sixth = 4.0 * third * third;
  double of_third = 4.0 * third;
  for (int k = 0; k < order; ++k) {
    of_sixth *= (-6.0 - k) / x;
    of_third *= (-3.0 - k) / x;
  }
  return of_sixth - of_third;
}
/// The same less the Taylor polynomial.
class smooth_pair {
 public:
  explicit smooth_pair(const lennard_jones_liquid_options& of) : centre_(of.cutoff * of.cutoff) {
    for (int m = 0; m <= of.smoothness; ++m) at_centre_.push_back(pair_derivative(centre_, m));
  }
  double derivative(double x, int order) const {
    double result = pair_derivative(x, order);
    double term = 1.0;
    for (std::size_t m = static_cast<std::size_t>(order); m < at_centre_.size(); ++m) {
      result -= at_centre_[m] * term;
      term *= (x - centre_) / (static_cast<double>(m) - order + 1.0);
    }
    return result;
  }
  double centre() const { return centre_; }

 private:
  double centre_;
  std::vector<double> at_centre_{};
};

/// By all pairs; what rounding may add to a component of the force of each atom, to V, and to the virial.
struct all_pairs {
  all_pairs(const lennard_jones_liquid& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v)
      : force(Eigen::VectorXd::Zero(q.size())),
        derivative(force),
        force_error(force),
        derivative_error(force) {
    const double side = system.side();
    const double* const from = q.data();
    const smooth_pair pair(system.options());
    long double energies = 0.0;
    long double virials = 0.0;
    for (Eigen::Index i = 0; i < q.size(); i += 3) {
      for (Eigen::Index j = i + 3; j < q.size(); j += 3) {
        std::array<double, 3> way{};
        double x = 0.0;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          double along = from[i + axis] - from[j + axis];
          along -= side * std::nearbyint(along / side);
          way[static_cast<std::size_t>(axis)] = along;
          x += along * along;
        }
        if (x >= pair.centre()) continue;
        const Eigen::Vector3d d(way[0], way[1], way[2]);
        const double push = -2.0 * pair.derivative(x, 1);
        const double slope = -4.0 * pair.derivative(x, 2);
        const double steeper = 8.0 * std::abs(pair.derivative(x, 3));
        const Eigen::Vector3d w = v.segment<3>(i) - v.segment<3>(j);
        const Eigen::Vector3d change = push * w + slope * d.dot(w) * d;
        force.segment<3>(i) += push * d;
        force.segment<3>(j) -= push * d;
        derivative.segment<3>(i) += change;
        derivative.segment<3>(j) -= change;
        energies += pair.derivative(x, 0);
        virials += push * x;
        // Each of two positions is rounded to eps of a side, or of what it is; some 30 roundings of either
        // formula, whose powers magnify that of x by up to 8.
        const double moved = 4.0 * eps * (side + q.cwiseAbs().maxCoeff());
        const double rounded = 60.0 * eps;
        const double r = std::sqrt(x);
        const double stiff = std::abs(push) + std::abs(slope) * x;
        const double stiffer = (3.0 * std::abs(slope) + steeper * x) * r;
        for (const Eigen::Index k : {i, j}) {
          force_error.segment<3>(k).array() += stiff * moved + rounded * std::abs(push) * r;
          derivative_error.segment<3>(k).array() += (stiffer * moved + rounded * stiff) * w.norm();
        }
        potential_error += std::abs(push) * r * moved + rounded * (std::abs(pair_derivative(x, 0)) + 1.0);
        virial_error += (stiff * moved + rounded * std::abs(push) * r) * r;
      }
    }
    potential = static_cast<double>(energies);
    virial = static_cast<double>(virials);
  }
  Eigen::VectorXd force;
  Eigen::VectorXd derivative;
  Eigen::VectorXd force_error;
  Eigen::VectorXd derivative_error;
  double potential = 0.0;
  double potential_error = 0.0;
  double virial = 0.0;
  double virial_error = 0.0;
};

}  // namespace nysalt::test
