// SPDX-License-Identifier: BSL-1.0
// The equations of phase fitting, and their solution.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "nysalt/run_time_family.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt::detail {

/// By how much a step of a word differs from the rotation by z, z^2 = x, on q'' = -x q, each relative to
/// the power of x at which consistent words begin to differ, so that nothing cancels as z -> 0:
///   (trace/2 - cos z)/x^2,  (M_qp - sin z/z)/x,  (M_pq + z sin z)/x^2
/// and, where the word is not symmetric, (M_qq - M_pp)/(2 x). As the determinant is 1, one of them follows
/// from the others; but which does depends on z.
Eigen::VectorXd defect_of_rotation(const run_time_word& word, const std::vector<double>& coefficients,
                                   bool symmetric, double x);

/// d defect_i / d theta_k. The matrix of a word is affine in each coefficient (but those of rotations), so
/// that a difference over a step of 1 is the derivative.
Eigen::MatrixXd jacobian_of_defect(const run_time_family& family, const Eigen::VectorXd& theta, double x);

/// Result of a continuation.
struct phase_fitting {
  std::optional<Eigen::VectorXd> theta;  ///< at the z that was asked for; nothing: it ended before
  double reached;                        ///< the last z with a solution
};

/// The parameters that turn the oscillator exactly by z in a step, nearest to `nearest`: the solution at z
/// that continues those for smaller z. Nothing where there are fewer parameters than equations, or where a
/// quadratic part is split off.
phase_fitting fit_phase(const run_time_family& family, const Eigen::VectorXd& nearest, double z);

}  // namespace nysalt::detail
