// SPDX-License-Identifier: BSL-1.0
// By how much a symmetric word changes the energy of a harmonic oscillator, exactly.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "nysalt/run_time_word.hpp"

namespace nysalt {

namespace detail {

/// A number r with r^2 = rho, and dr/dc_i for each coefficient c_i of a word.
struct energy_defect {
  double value;
  Eigen::VectorXd slopes;
};
energy_defect energy_defect_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                                          double z);

}  // namespace detail

/// Energy error rho of a symmetric word at z = h omega. With the matrix [[A, B], [C, A]] of a step in (omega
/// q, p),
///   rho = (B + C)^2 / (2 (1 - A^2)):
/// after n steps from the canonical distribution the energy has grown by sin^2(n t) rho kT on average, cos t
/// = A [blanes_casas_sanz_serna_2014]. Infinite where |A| >= 1, as the word is not stable there. Cost: two
/// evaluations of each letter on one number. Throws std::invalid_argument unless there is a coefficient for
/// each slot, or if the word rotates, has letters O or a processor.
double energy_error_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                                  double z);

}  // namespace nysalt
