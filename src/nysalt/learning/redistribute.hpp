// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/flow_map_data.hpp"

namespace nysalt::detail {

/// Each rank gets the trajectories that it has in `next`, a share of more, from the rank that had them. Each
/// message is waited for in one order that all ranks keep, so that none waits for ever. Cost: a message for
/// each pair of ranks whose shares meet.
void redistribute(flow_map_data& data, const shard& next, Eigen::Index dimension);

}  // namespace nysalt::detail
