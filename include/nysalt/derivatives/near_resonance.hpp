// SPDX-License-Identifier: BSL-1.0
// Distance of the steps of a word from half turns of a stiff oscillation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/run_time_word.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// A step of a word turns a stiff oscillation by nearly k half turns, and small nonlinear errors add up from
/// step to step.
struct resonance {
  frequency_band band;  ///< frequency band that holds the resonant frequency
  int half_turns;       ///< k
};

/// Number of steps from which a run is long: in shorter ones nothing was seen of a resonance that is as far
/// as resonance_distance or a few times nearer.
inline constexpr std::int64_t long_run = 10'000;
/// The share of k pi that the phase of a step should keep from k pi in long runs. On the FPU chain (omega =
/// 50) the largest energy error of 20 000 steps was, over that of the first tenth of them, 1.0 to 1.5 for
/// learned fg4 up to 16 % below 2 pi, 1.6 at 10 %, 2.1 at 7 % and 3 at 10 % above; for learned aba6 1.0 at 28
/// %, 3 at 13 %.
inline constexpr double resonance_distance = 0.1;

/// The first resonance of a band that does not begin at zero, of a word whose step has nearly the phase h
/// omega there, as those that follow the motion have; nothing if there is none, and of words with rotations.
/// A processor changes nothing. Cost: some 32 steps on an oscillator for each band.
std::optional<resonance> near_resonance(const run_time_word& word, const std::vector<double>& coefficients,
                                        const std::vector<frequency_band>& bands, double step);

/// "a step turns the frequencies 49 to 51 by nearly 2 pi ..."
std::string in_words(const resonance& near);

}  // namespace nysalt
