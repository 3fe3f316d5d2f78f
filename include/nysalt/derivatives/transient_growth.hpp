// SPDX-License-Identifier: BSL-1.0
// Transient growth: how much a word with rotations magnifies an oscillation, by resonances above all.
#pragma once

#include <cstdint>
#include <vector>

#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// Largest |M^n| of n = 1 .. steps steps on q'' = -(theta^2 + k) q, k > 0, in the norm of its energy, which
/// the motion itself conserves; see step_on_oscillator(). Stable or not is too coarse a question where words
/// rotate: at h omega = j pi the impulse method has the trace 2 (-1)^j for every soft force, and grows
/// without a bound, but slowly; others are stable there but for a width or a rate that is nil. With trace/2 =
/// +-cos t, t <= pi/2, +-M^n = cos(n t) + (+-M - cos t) sin(n t)/sin t, taken at n t = pi/2 or the last step,
/// whichever is first; cosh and sinh where it is unstable. NaN where a coefficient is. Cost: a step.
double transient_growth(const run_time_word& word, const std::vector<double>& coefficients, double theta,
                        double k, std::int64_t steps);

}  // namespace nysalt
