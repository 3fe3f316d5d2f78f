// SPDX-License-Identifier: BSL-1.0
// Growth of two coupled modes under a word with rotations.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// Logarithm of the spectral radius of one step on q'' = -(Theta^2 + K) q with Theta = diag(theta) and a
/// symmetric 2 x 2 matrix K, see step_on_oscillator(); 0 where the step is stable. A symplectic matrix of
/// four rows has eigenvalues in pairs lambda, 1/lambda, and y = lambda + 1/lambda solves y^2 - a y + b - 2 =
/// 0 with a = tr M and b = (a^2 - tr M^2)/2. Two modes that K couples grow where theta_1 + theta_2 is near 2
/// pi k: there eigenvalues of opposite Krein signature meet [hairer_lubich_wanner_2006, section XIII].
/// Infinite where a coefficient is not finite. Cost: four steps on two oscillators.
double growth_of_pair(const run_time_word& word, const std::vector<double>& coefficients,
                      const Eigen::Array2d& theta, const Eigen::Matrix2d& k);

}  // namespace nysalt
