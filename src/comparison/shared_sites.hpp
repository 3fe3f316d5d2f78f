// SPDX-License-Identifier: BSL-1.0
// Sampled trajectories of which each is shared by all ranks.
#pragma once

#include "nysalt/communicator.hpp"
#include "sampled_run.hpp"

namespace nysalt::program {

/// The trajectories of a plan, each stepped by all ranks, which share its sites. To the bit what one rank
/// makes of them; rank 0 sees each sampled state as a whole. Of a system and a method for which
/// can_be_distributed() is true. Memory: on each rank one whole start and a share of each
/// trajectory; on rank 0 also the state of a sample, and where the run is saved the states of all
/// trajectories. Collective.
double run_on_shared_sites(const initial_value_problem& made, const initial_states& starts,
                           const method& method, const sampled_plan& plan, const record_taker& take,
                           const counter& progress, const communicator& ranks);

}  // namespace nysalt::program
