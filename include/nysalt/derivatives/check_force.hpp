// SPDX-License-Identifier: BSL-1.0
// A check of forces that users write by hand.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt {

/// Result of check_force(). Each defect is relative to the largest entry, over all points, of the function
/// checked: of the force, of its Jacobian, of the velocity, of its Jacobian. They are 0 where there is
/// nothing to compare.
struct force_check {
  double gradient_defect = 0.0;  ///< gradient defect of force = -grad V
  Eigen::Index coordinate =
      0;  ///< coordinate with the largest gradient defect, from 0; -1: checked along directions at random
  double derivative_defect =
      0.0;                   ///< derivative defect of force_derivative, against differences of the force
  double kick_defect = 0.0;  ///< defect of the system's own kick, p += c force(q)
  Eigen::Index kick_coordinate = 0;  ///< coordinate with the largest kick defect
  double range_defect = 0.0;  ///< range defect of forces and kicks in ranges of sites, of a LocalSystem;
                              ///< infinite if one reads sites beyond its reach
  Eigen::Index range_coordinate = 0;  ///< coordinate with the largest range defect
  double soft_defect = 0.0;  ///< soft defect of soft_force = force + K q, K the quadratic part of modes()
  Eigen::Index soft_coordinate = 0;  ///< coordinate with the largest soft defect
  double asymmetry = 0.0;            ///< asymmetry of the Jacobian of the force: a gradient's is symmetric
  double velocity_defect = 0.0;      ///< velocity defect of velocity = grad K
  Eigen::Index velocity_coordinate = 0;  ///< coordinate with the largest velocity defect
  double velocity_asymmetry =
      0.0;                 ///< velocity asymmetry of the Jacobian of a velocity without a kinetic energy
  double tolerance = 0.0;  ///< tolerance of the gradient: error bound of the derivatives used
  /// Tolerance of the asymmetry: 1.5e-8 with exact derivatives, 1.8e-4 with differences.
  double asymmetry_tolerance = 0.0;
  double kick_tolerance = 0.0;        ///< tolerance of the kick, of ranges and of the soft force
  double derivative_tolerance = 0.0;  ///< tolerance of force_derivative, which is compared with differences
  double velocity_tolerance = 0.0;    ///< tolerance of the velocity and of its Jacobian's asymmetry
  bool has_potential = false;  ///< whether there was a V to compare with; else only the symmetry is checked
  bool finite = true;          ///< whether all functions and their derivatives are, at all points
  bool passes_beside = false;  ///< whether it fails at the points, but not a little beside them

  /// Whether everything is finite and every defect within its tolerance.
  bool passed() const {
    return finite && gradient_defect <= tolerance && kick_defect <= kick_tolerance &&
           range_defect <= kick_tolerance && soft_defect <= kick_tolerance &&
           derivative_defect <= derivative_tolerance && asymmetry <= asymmetry_tolerance &&
           velocity_defect <= velocity_tolerance && velocity_asymmetry <= velocity_tolerance;
  }
  /// The first thing that is wrong, in the order in which mistakes cause others.
  std::string report() const;

 private:
  std::string objection() const;
};

// A check of what users write by hand.

/// Compares force with -grad V, kick with force, soft_force with the force less the quadratic part (up to 64
/// coordinates), and force_derivative with differences of the force, and checks the symmetry of f'(q), at
/// the given points; at the momenta compares a velocity of the system's own with grad K, or checks the
/// symmetry of its Jacobian. Derivatives are automatic where the system allows, else central differences; up
/// to 64 coordinates along each, of more along four directions at random. What fails is checked once more
/// at a small distance: a kink shows there. Forces count as energies over the length of each coordinate,
/// which is how far the points and the states `seen` beside them lie apart, and differences go a part of it:
/// two points or more, of the motion, give the unit; of one it is how far it is from the origin. Cost: some N
/// forces and potentials a point, at most 64 of them.
///
/// Throws std::invalid_argument if there are no points, if there is not a momentum for each, if one has not
/// the system's dimension, or if a function of the system changes how numbers are rounded.
force_check check_force(const model& system, const std::vector<Eigen::VectorXd>& points,
                        const std::vector<Eigen::VectorXd>& momenta, const phase_points& seen = {});
/// Checks with the same numbers as points and as momenta.
force_check check_force(const model& system, const std::vector<Eigen::VectorXd>& points);

}  // namespace nysalt
