// SPDX-License-Identifier: BSL-1.0
// Sampled trajectories, as many at a time as fit into memory.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "prepared_problem.hpp"
#include "sampled_plan.hpp"

namespace nysalt::program {

/// Hands records over at rank 0, wave by wave of as many trajectories as fit into memory; in a wave stretch
/// by stretch, and in that in the order of the trajectories. Rank 0's plan says where to begin. Progress is
/// told in thousandths. Collective.
void run(const prepared_problem& system, const tabulated& method, const sampled_plan& plan,
         const std::function<void(std::int64_t, const record&)>& take, const counter& progress);

/// Takes given states, instead of starts, to the end of a plan: each of dimension() numbers, one trajectory
/// after the other. With the bits of run(); where that is lost all of q and p become NaN. Throws refusal for
/// a state that is not finite; then all are as they were.
void integrate(const prepared_problem& system, const tabulated& method, const trajectories_plan& plan,
               std::span<double> q, std::span<double> p, const counter& progress);

}  // namespace nysalt::program
