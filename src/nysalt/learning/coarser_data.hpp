// SPDX-License-Identifier: BSL-1.0
// Held-out data in longer steps: methods of different steps are compared at the times that they share.
#pragma once

#include "nysalt/flow_map_data.hpp"
#include "nysalt/losses/after_steps.hpp"

namespace nysalt::detail {

/// Pairs over `times` steps each, of whole stretches from the beginning of each trajectory on. Without noise.
flow_map_data coarser(const flow_map_data& data, int times);

/// The multiples of `times` nearest to the times of a loss, in steps that are longer by that factor; without
/// steps if the trajectories, of `shortest` steps, have no multiple.
after_steps_options in_longer_steps(const after_steps_options& how, int times, int shortest);

}  // namespace nysalt::detail
