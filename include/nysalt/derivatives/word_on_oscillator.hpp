// SPDX-License-Identifier: BSL-1.0
// trace/2 of a word on the harmonic oscillator, as a polynomial.
#pragma once

#include <vector>

#include "nysalt/derivatives/bernstein.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// trace/2 of step_on_oscillator() as a polynomial in k, low <= k <= high. The step is stable where it is
/// within +-1.
bernstein_polynomial half_trace(const run_time_word& word, const std::vector<double>& coefficients,
                                double theta, double low, double high);

}  // namespace nysalt
