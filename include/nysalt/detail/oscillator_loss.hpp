// SPDX-License-Identifier: BSL-1.0
// Distance of one step of a word from the rotation of oscillators: a loss without data.
#pragma once

#include <vector>

#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt::detail {

/// The mean over frequencies of the bands of |M - R|^2 in coordinates (omega q, p), M the matrix of one step
/// and R that of the exact flow; nothing for words with rotations, which are exact on their modes. Its minima
/// are starts of a search where the step is so large that no trajectory from elsewhere stays finite. Cost:
/// some microseconds.
objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step);

}  // namespace nysalt::detail
