// SPDX-License-Identifier: BSL-1.0
// Data that can be learned from, as those that came from elsewhere may not be.
#pragma once

#include "nysalt/flow_map_data.hpp"

namespace nysalt {

/// Throws std::invalid_argument unless the data are of this system, hold pairs of its size, all finite, and
/// trajectories that cover them; for data that came from elsewhere. What is not finite is named: coordinate,
/// pair and trajectory, all but coordinates counted from 0. Collective, if ranks share the data.
void require_valid(const flow_map_data& data, const model& system);

}  // namespace nysalt
