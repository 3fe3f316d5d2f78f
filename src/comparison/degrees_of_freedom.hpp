// SPDX-License-Identifier: BSL-1.0
// Momenta that the motion can have.
#pragma once

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// The number of independent momenta that a state can have: all of them, less the sums of momenta that are
/// conserved and 0 from all starts, as of a cluster at rest, and in up to 24 coordinates less such angular
/// momenta. Thermal energy is shared by these. In a bath, for a kinetic energy that is not sum p^2/2m and of
/// more than 400 coordinates: the number of coordinates. Cost: some forces for each relation that is
/// possible.
Eigen::Index degrees_of_freedom(const initial_value_problem& problem);

}  // namespace nysalt::program
