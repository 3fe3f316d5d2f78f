// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/near_resonance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "nysalt/detail/step_on_oscillator.hpp"

namespace nysalt {

namespace {

double half_trace_at(const run_time_word& word, const std::vector<double>& coefficients, double z) {
  const auto times_k = [k = z * z](double x) { return k * x; };
  double qq = 1.0, pq = 0.0, qp = 0.0, pp = 1.0;
  step_on_oscillator(word, coefficients, 0.0, times_k, qq, pq);
  step_on_oscillator(word, coefficients, 0.0, times_k, qp, pp);
  return 0.5 * (qq + pp);
}

}  // namespace

std::optional<resonance> near_resonance(const run_time_word& word, const std::vector<double>& coefficients,
                                        const std::vector<frequency_band>& bands, double step) {
  if (word.rotates()) return std::nullopt;
  constexpr int samples = 16;
  for (const auto& band : bands) {
    if (!(band.low > 0.0)) continue;
    for (int i = 0; i <= samples; ++i) {
      const double z = step * (band.low + (band.high - band.low) * i / samples);
      const double half_turns = std::max(1.0, std::round(z / std::numbers::pi));
      const double width = resonance_distance * half_turns * std::numbers::pi;
      if (!(std::abs(z - half_turns * std::numbers::pi) < width)) continue;
      const double trace = std::abs(half_trace_at(word, coefficients, z));
      if (trace > std::cos(std::min(width, 0.5 * std::numbers::pi))) {
        return resonance{band, static_cast<int>(half_turns)};
      }
    }
  }
  return std::nullopt;
}

std::string in_words(const resonance& near) {
  return fmt::format(
      "a step turns oscillations of the frequencies {:.4g} to {:.4g} by {}pi, to within {:g} %: in runs of "
      "more "
      "than {} steps energies may drift; take another step for these",
      near.band.low, near.band.high, near.half_turns == 1 ? "" : fmt::format("{} ", near.half_turns),
      100.0 * resonance_distance, long_run);
}

}  // namespace nysalt
