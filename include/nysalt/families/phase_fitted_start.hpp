// SPDX-License-Identifier: BSL-1.0
// A start of a search where the highest frequency is known.
#pragma once

#include <optional>

#include "nysalt/run_time_family.hpp"

namespace nysalt {

/// The member of a family whose step is the exact rotation on the oscillator at z = step * frequency, near to
/// one of the starts of the family: its classical members in their order, then the others. Letters O count
/// for nothing. Nothing where the word rotates by itself, has fewer parameters than the rotation has
/// equations (two if it is symmetric, else three), or no start leads to a member in the ranges. Throws
/// std::invalid_argument unless z is positive and finite. Cost: some milliseconds.
std::optional<named_parameters> phase_fitted_start(const run_time_family& family, double z);

}  // namespace nysalt
