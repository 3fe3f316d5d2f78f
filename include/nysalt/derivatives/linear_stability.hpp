// SPDX-License-Identifier: BSL-1.0
// For which z = h omega a method is stable on the harmonic oscillator, exactly.
#pragma once

#include <vector>

#include "nysalt/derivatives/stability_window.hpp"
#include "nysalt/method.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// All windows. Their ends are roots of trace/2 = +-1, to the last bits that the values determine; windows
/// that touch where the matrix is +-I are one. The bath is left out. Extrema are isolated by bounds on whole
/// intervals, so that the narrowest window or gap is found unless rounding hides it, or an extremum passes
/// +-1 by less than 1e-10. Cost: some 0.05 ms for 10 letters, 1 ms for 40. Throws std::invalid_argument if
/// the word has more than 64 evaluations a step, where it rotates, or unless there is a coefficient for each
/// slot.
stability_chart chart_stability(const run_time_word& word, const std::vector<double>& coefficients);
/// Stability chart of a word whose letters are known_letters.
template <TypeLevelWord W>
stability_chart chart_stability(const W& word,
                                const typename W::template coefficients<double>& coefficients) {
  return chart_stability(run_time_word(word), std::vector<double>(coefficients.begin(), coefficients.end()));
}

/// Only the windows of chart_stability().
template <Word W>
std::vector<stability_window> stability_windows(
    const W& word, const typename W::template coefficients<double>& coefficients) {
  return chart_stability(word, coefficients).windows;
}

/// The windows of a method, at its own coefficients.
template <Method M>
std::vector<stability_window> stability_windows(const M& method) {
  return stability_windows(word_of(method), method.coefficients());
}

/// End of the window that begins at z = 0; 0 where there is none.
template <Method M>
double stability_limit(const M& method) {
  const auto windows = stability_windows(method);
  return windows.empty() || windows.front().low > 0.0 ? 0.0 : windows.front().high;
}

}  // namespace nysalt
