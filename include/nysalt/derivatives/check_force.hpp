// SPDX-License-Identifier: BSL-1.0
// A check of what users write by hand.
#pragma once

#include <vector>

#include "nysalt/derivatives/force_check.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_points.hpp"

namespace nysalt {

namespace detail {
force_check check_force(const model& system, const std::vector<Eigen::VectorXd>& points,
                        const std::vector<Eigen::VectorXd>& momenta, const phase_points& seen);
}  // namespace detail

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
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points,
                        const std::vector<vector<double, S::dimension>>& momenta,
                        const phase_points& seen = {}) {
  return detail::check_force(system, {points.begin(), points.end()}, {momenta.begin(), momenta.end()}, seen);
}
/// Checks with the same numbers as points and as momenta.
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points) {
  return check_force(system, points, points);
}

}  // namespace nysalt
