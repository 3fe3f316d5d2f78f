// SPDX-License-Identifier: BSL-1.0
// Starts of an ensemble on which methods are judged.
#pragma once

#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_points.hpp"

namespace nysalt {

/// Starts to judge methods on: the first 512 of an ensemble by a seed of their own, 64 of one whose states
/// are expensive to make, fewer where it has no more or they are large; in a bath repeated up to 192.
phase_points starts_to_judge(const model& system, const initial_states& ensemble);

}  // namespace nysalt
