// SPDX-License-Identifier: BSL-1.0
// What one step of a method keeps. Each law returns how far it is broken, in units of what rounding may do:
// above 1 it is.
#pragma once

#include "../support/rounding.hpp"
#include "nysalt/derivatives/reversibility.hpp"
#include "nysalt/derivatives/symplecticity.hpp"

namespace nysalt::test {

/// A quarter of a radian of the fastest motion.
inline double gentle_step(const shears& at) { return 0.25 / at.frequency(); }

/// Rounding of a Jacobian: each of its letters rounds every entry, twice, and later ones magnify it; the
/// products with Omega and the transpose add 2 n terms of the square of that size.
template <SeparableSystem S, Method M>
double jacobian_rounding(const S& system, const M& method, double step, const shears& at) {
  const double size_of_jacobian = transient_growth(method, step, at);
  return 4.0 * static_cast<double>(size(system)) * roundings(method, size(system)) * eps * size_of_jacobian *
         size_of_jacobian;
}

template <SeparableSystem S, Method M>
double symplecticity_broken(const S& system, const M& method, const phase_point<double, S::dimension>& x) {
  const auto at = shears_at(system, x);
  const double step = gentle_step(at);
  return symplecticity_defect(system, method, step, x) / jacobian_rounding(system, method, step, at);
}

/// How far the determinant of the Jacobian is from one. Where the entries of J err by d, det J errs by
/// sum_ij |adj J|_ij d: 4 n^2 terms, adj J = J^-1 for det J = 1, and J^-1 is the Jacobian of the step back.
template <SeparableSystem S, Method M>
double volume_broken(const S& system, const M& method, const phase_point<double, S::dimension>& x) {
  const auto at = shears_at(system, x);
  const double step = gentle_step(at);
  const double volume = jacobian(step_map(system, method, step), x).determinant();
  const double terms = 4.0 * static_cast<double>(size(system));
  return std::abs(volume - 1.0) / (terms * jacobian_rounding(system, method, step, at));
}

/// Two steps, whose letters each round every coordinate twice.
template <SeparableSystem S, Method M>
double reversibility_broken(const S& system, const M& method, const phase_point<double, S::dimension>& x) {
  const auto at = shears_at(system, x);
  const double step = gentle_step(at);
  const double magnified = transient_growth(method, step, at);
  const double rounding = 4.0 * roundings(method, size(system)) * eps * size_of(x) * magnified * magnified;
  return reversibility_defect(system, method, step, x) / rounding;
}

/// A step forth and a step back.
template <SeparableSystem S, Method M>
double undoing_broken(const S& system, const M& method, const phase_point<double, S::dimension>& x) {
  const auto at = shears_at(system, x);
  const double step = gentle_step(at);
  const double magnified = transient_growth(method, step, at);
  auto y = x;
  step_map(system, method, step)(y);
  step_map(system, method, -step)(y);
  return distance(x, y) / (4.0 * roundings(method, size(system)) * eps * size_of(x) * magnified * magnified);
}

}  // namespace nysalt::test
