// SPDX-License-Identifier: BSL-1.0
// Checks of the force before learning: a wrong force would not be noticed otherwise.
#pragma once

#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// check_force() at four states, from the middle of each quarter of the data. A system that is a
/// potential only has nothing to check. How far these and their finishes lie apart gives the lengths of
/// coordinates. Throws std::invalid_argument with its report. The data must be valid.
void require_sound_force(const model& system, const flow_map_data& data);

}  // namespace nysalt
