// SPDX-License-Identifier: BSL-1.0
// Linear stability: the windows of z = h omega in which a method is stable, and the distance from their ends.
#pragma once

#include <vector>

#include "nysalt/method.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Stable for low <= z <= high, but for a single point where the matrix is a Jordan block.
struct stability_window {
  double low;   ///< the least z = h omega
  double high;  ///< the largest z = h omega
};

/// All windows, from small z to large, and the z within them where two touch.
struct stability_chart {
  std::vector<stability_window> windows;  ///< disjoint, in order
  /// There the matrix is +-I: an oscillator is back after a step or two, and the errors that a nonlinear
  /// system makes at each add up.
  std::vector<double> touching;
};

/// Whether all z in low..high lie in one window.
bool is_stable(const std::vector<stability_window>& windows, double low, double high);

namespace detail {

/// The parts of 0..highest that lie in no window.
std::vector<stability_window> gaps_below(const std::vector<stability_window>& windows, double highest);

}  // namespace detail

// Stability margin: the distance of a step from the ends of the windows of stability.

/// Stability margin of z = low..high, as a share of the stability interval: 1 - high/end, and where the
/// window has a beginning above 0 also 1 - beginning/low, whichever is less. A step may grow by the factor
/// 1/(1 - margin) before it is unstable. Negative if some z is unstable: then the end is the end of the last
/// window which holds z before it; minus infinity if there is none.
double stability_margin(const std::vector<stability_window>& windows, double low, double high);

/// Steps from low to high.
struct step_range {
  double low;   ///< the least step
  double high;  ///< the largest step; may be infinite
};

/// Every step at which each band lies in a window, from small to large. Without bands all steps.
std::vector<step_range> stable_steps(const std::vector<stability_window>& windows,
                                     const std::vector<frequency_band>& bands);

// For which z = h omega a method is stable on the harmonic oscillator, exactly.

/// All windows. Their ends are roots of trace/2 = +-1, to the last bits that the values determine; windows
/// that touch where the matrix is +-I are one. The bath is left out. Extrema are isolated by bounds on whole
/// intervals, so that the narrowest window or gap is found unless rounding hides it, or an extremum passes
/// +-1 by less than 1e-10. Cost: some 0.05 ms for 10 letters, 1 ms for 40. Throws std::invalid_argument if
/// the word has more than 64 evaluations a step, where it rotates, or unless there is a coefficient for each
/// slot.
stability_chart chart_stability(const word& letters, const std::vector<double>& coefficients);
/// Only the windows of chart_stability().
std::vector<stability_window> stability_windows(const word& letters, const std::vector<double>& coefficients);

/// The windows of a method, at its own coefficients.
inline std::vector<stability_window> stability_windows(const nysalt::method& method) {
  return stability_windows(method.letters(), method.coefficients());
}

/// End of the window that begins at z = 0; 0 where there is none.
inline double stability_limit(const method& method) {
  const auto windows = stability_windows(method);
  return windows.empty() || windows.front().low > 0.0 ? 0.0 : windows.front().high;
}

}  // namespace nysalt
