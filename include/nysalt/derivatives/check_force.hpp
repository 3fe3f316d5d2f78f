// SPDX-License-Identifier: BSL-1.0
// A check of what users write by hand.
#pragma once

#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/force_source.hpp"
#include "nysalt/sentence.hpp"

namespace nysalt {

/// Compares force with -grad V, kick with force, soft_force with the force less the quadratic part (up to 64
/// coordinates), and force_derivative with differences of the force, and looks at the symmetry of f'(q), at
/// the given points; at the momenta compares a velocity of the system's own with grad K, or looks at the
/// symmetry of its Jacobian. Derivatives are automatic where the system allows, else central differences; up
/// to 64 coordinates along each, of more along four directions at random. What fails is looked at once more
/// a little beside: a kink shows there. Forces count as energies over the length of each coordinate, which is
/// how far the points and the states `seen` beside them lie apart, and differences go a part of it: two
/// points or more, of the motion, tell the unit; of one it is how far it is from the origin. Cost: some N
/// forces and potentials a point, at most 64 of them.
///
/// Throws std::invalid_argument if there are no points, if there is not a momentum for each, or if one has
/// not the system's dimension.
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points,
                        const std::vector<vector<double, S::dimension>>& momenta,
                        const std::vector<phase_point<double, S::dimension>>& seen = {}) {
  if (points.empty()) throw std::invalid_argument("check_force: no points to check at; give it one or more");
  if (momenta.size() != points.size()) {
    throw std::invalid_argument(sentence("check_force: {} points with {} momenta; give it one for each",
                                         points.size(), momenta.size()));
  }
  for (std::size_t m = 0; m < points.size(); ++m) {
    for (const auto* x : {&points[m], &momenta[m]}) {
      if (x->size() == size(system)) continue;
      throw std::invalid_argument(sentence("check_force: point {} has {} coordinates, the system {}", m + 1,
                                           x->size(), size(system)));
    }
  }
  for (const auto& x : seen) {
    if (x.q.size() == size(system) && x.p.size() == size(system)) continue;
    throw std::invalid_argument(
        sentence("check_force: a state has {} coordinates, the system {}", x.q.size(), size(system)));
  }
  const detail::force_source_of<S> source(system);
  const std::vector<Eigen::VectorXd> at(points.begin(), points.end());
  const std::vector<Eigen::VectorXd> with(momenta.begin(), momenta.end());
  std::vector<Eigen::VectorXd> places = at;
  std::vector<Eigen::VectorXd> all_momenta = with;
  for (const auto& x : seen) {
    places.emplace_back(x.q);
    all_momenta.emplace_back(x.p);
  }
  return detail::examine_force(source, at, with, detail::lengths_of(places), detail::lengths_of(all_momenta));
}
/// The same numbers as points and as momenta.
template <SeparableSystem S>
force_check check_force(const S& system, const std::vector<vector<double, S::dimension>>& points) {
  return check_force(system, points, points);
}

}  // namespace nysalt
