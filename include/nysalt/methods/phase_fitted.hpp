// SPDX-License-Identifier: BSL-1.0
// Phase-fitted methods: coefficients for which an oscillation of one frequency keeps its phase.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "nysalt/family.hpp"
#include "nysalt/model.hpp"

// The equations of phase fitting, and their solution.

namespace nysalt::detail {

/// By how much a step of a word differs from a rotation, and its derivatives by the parameters.
struct rotation_defects {
  Eigen::VectorXd values;
  Eigen::MatrixXd jacobian;  ///< d values_i / d theta_k
};

/// For each x: by how much a step of a member differs from the rotation by z, z^2 = x, on q'' = -x q, each
/// relative to the power of x at which consistent words begin to differ, so that nothing cancels as z -> 0:
///   (trace/2 - cos z)/x^2,  (M_qp - sin z/z)/x,  (M_pq + z sin z)/x^2
/// and, where the word is not symmetric, (M_qq - M_pp)/(2 x). As the determinant is 1, one of them follows
/// from the others; but which does depends on z. The matrix of a word is affine in each coefficient (but not
/// in coefficients of rotations), so that a difference over a step of 1 is the derivative.
/// Cost: the matrices, polynomials in x, are made once for all x.
std::vector<rotation_defects> defects_of_rotation(const nysalt::family& family, const Eigen::VectorXd& theta,
                                                  const std::vector<double>& all_x);

/// Result of a continuation.
struct phase_fitting {
  std::optional<Eigen::VectorXd> theta;  ///< at the z that was asked for; nothing: it ended before
  double reached;                        ///< the last z with a solution
};

/// The parameters that turn the oscillator exactly by z in a step, nearest to `nearest`: the solution at z
/// that continues those for smaller z. Nothing where there are fewer parameters than equations, or where a
/// quadratic part is split off.
phase_fitting fit_phase(const family& family, const Eigen::VectorXd& nearest, double z);

}  // namespace nysalt::detail

// A start of a search where the highest frequency is known.

namespace nysalt {

/// The member of a family whose step is the exact rotation on the oscillator at z = step * frequency, near to
/// one of the starts of the family: its classical members in their order, then the others. Letters O count
/// for nothing. Nothing where the word rotates by itself, has fewer parameters than the rotation has
/// equations (two if it is symmetric, else three), or no start leads to a member in the ranges. Throws
/// std::invalid_argument unless z is positive and finite. Cost: some milliseconds.
std::optional<named_parameters> phase_fitted_start(const nysalt::family& family, double z);

/// A classical method with its coefficients changed, within a family of its word, such that its step is
/// the exact rotation on the oscillator at z = h omega: trace/2 = cos z and M_qp = sin z/z. Such methods are
/// called phase-fitted and amplification-fitted [van_de_vyver_2007]; exponentially or trigonometrically
/// fitted where they are built from the functions that they keep [simos_vigo_aguiar_2003;
/// monovasilis_kalogiratou_simos_2013]. Of the parameters with that property they are those nearest to the
/// method's own, which they become as z -> 0. Hence the order is the order of the method if h -> 0 at a fixed
/// omega; at a fixed z it is 2.
///
/// The frequency must be known; no data are needed. Of BAGAB (fg_chin) they have a closed form,
///   b = 2/z^2 - cot(z/2)/z,  c = ((1 - 2 b) z^2 - 4 (1 - sin z/z))/(2 z^4).
/// Words of two kicks without gradient cannot: trace/2 would need a term z^4/24, and z^4/32 is the most.
/// Others follow from z = 0 by Newton's method until their coefficients have no real continuation.
///
/// Throws std::invalid_argument unless the family is symmetric, with two parameters or more and without
/// rotations, and the method one of its starts, of order 4 or more; unless z is positive and finite, and
/// below the end of the coefficients. Cost: a millisecond; they are right to rounding.
method phase_fitted(const nysalt::family& family, const method& classical, double z);

namespace detail {

/// Source of phase_fitted() in docs/bibliography.bib.
inline constexpr std::string_view phase_fitted_source = "van_de_vyver_2007";

}  // namespace detail

/// The highest frequency of the system's modes, or of its bands if it declares no modes; 0 where it has
/// neither. (Bands have room for what soft forces add, which phases should not have.) phase_fitted() at
/// |step| times it suits the system.
double frequency_to_fit(const model& system);

}  // namespace nysalt
