// SPDX-License-Identifier: BSL-1.0
// How far a step is from the ends of the windows that a system's frequencies must lie in.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/derivatives/stability_window.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Of z = low..high, as a share of its window: 1 - high/end, and where the window has a beginning above 0
/// also 1 - beginning/low, whichever is less. A step may grow by the factor 1/(1 - margin) before it is
/// unstable. Negative if some z is unstable: then the end is that of the last window which holds z before it;
/// minus infinity if there is none.
inline double stability_margin(const std::vector<stability_window>& windows, double low, double high) {
  double end = 0.0;
  double margin_below = 1.0;
  for (const auto& window : windows) {
    if (!(window.low <= low)) break;
    end = window.high;
    margin_below = window.low > 0.0 ? 1.0 - window.low / low : 1.0;
  }
  if (!(end > 0.0)) return -std::numeric_limits<double>::infinity();
  return std::min(1.0 - high / end, margin_below);
}

/// Steps from low to high.
struct step_range {
  double low;   ///< the least step
  double high;  ///< the largest step; may be infinite
};

/// A resonance of an explicit word, whatever its coefficients: a step turns a stiff oscillation by k half
/// turns, and small nonlinear errors add up from step to step.
struct resonance {
  frequency_band band;  ///< of which a frequency comes near
  int half_turns;       ///< k of h omega = k pi
  step_range near;      ///< the steps that are too near for this band
};

/// From how many steps on a run is long: in shorter ones nothing was seen of a resonance that is as far as
/// resonance_distance or a few times nearer.
inline constexpr std::int64_t long_run = 10'000;
/// The share of k pi that h omega should keep from it in long runs. On the FPU chain (omega = 50) the largest
/// energy error of 20 000 steps was, over that of the first tenth of them, 1.0 to 1.5 for learned fg4 up to
/// 16 % below 2 pi, 1.6 at 10 %, 2.1 at 7 % and 3 at 10 % above; for learned aba6 1.0 at 28 %, 3 at 13 %.
inline constexpr double resonance_distance = 0.1;

/// The nearest resonance, relative to k pi, of a band that does not begin at zero, where it is nearer than
/// resonance_distance; nothing if there is none. Slow motion is far from pi, or unstable.
inline std::optional<resonance> near_resonance(const std::vector<frequency_band>& bands, double step) {
  std::optional<resonance> nearest;
  double least = resonance_distance;
  for (const auto& band : bands) {
    if (!(band.low > 0.0)) continue;
    const double low = step * band.low / std::numbers::pi;
    const double high = step * band.high / std::numbers::pi;
    for (const double k : {std::max(1.0, std::floor(low)), std::max(1.0, std::ceil(low)), std::ceil(high)}) {
      const double distance = std::max({0.0, 1.0 - high / k, low / k - 1.0});
      if (!(distance < least)) continue;
      least = distance;
      const double step_at = k * std::numbers::pi;
      nearest = {band,
                 static_cast<int>(k),
                 {(1.0 - resonance_distance) * step_at / band.high,
                  (1.0 + resonance_distance) * step_at / band.low}};
    }
  }
  return nearest;
}

/// "h omega comes within 10 % of 2 pi for the frequencies 49 to 51: ...", with the steps to take.
std::string in_words(const resonance& near);

/// Every step at which each band lies in a window, from small to large. Without bands all steps.
inline std::vector<step_range> stable_steps(const std::vector<stability_window>& windows,
                                            const std::vector<frequency_band>& bands) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<step_range> result{{0.0, infinity}};
  for (const auto& band : bands) {
    if (!(band.high > 0.0)) continue;
    std::vector<step_range> both;
    for (const auto& window : windows) {
      if (band.low == 0.0 && window.low > 0.0) continue;
      const double low = band.low > 0.0 ? window.low / band.low : 0.0;
      const double high = window.high / band.high;
      for (const auto& range : result) {
        const step_range common{std::max(low, range.low), std::min(high, range.high)};
        if (common.low < common.high) both.push_back(common);
      }
    }
    result = both;
  }
  return result;
}

}  // namespace nysalt
