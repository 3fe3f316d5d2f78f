// SPDX-License-Identifier: BSL-1.0
// Motion that is lost in rounding: q + h v = q.
#pragma once

#include <optional>
#include <string>

#include "plans.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// What is to be said of coordinates that have a velocity at the starts of a plan, and that no step moves, as
/// h v is less than half the distance of neighbouring doubles: their energy is conserved because nothing
/// happens. The velocity is the larger of those at the start and after a kick, which is small at no turning
/// point; what has less than 1e-16 of the kinetic energy is not asked for. Starts must be prepared. Cost: one
/// force at each of 16 starts, of more than 6000 coordinates fewer.
std::optional<std::string> warning_of_lost_motion(const prepared_problem& system,
                                                  const trajectories_plan& plan);

}  // namespace nysalt::program
