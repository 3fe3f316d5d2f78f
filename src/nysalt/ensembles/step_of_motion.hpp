// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

// The step of chains that burn in, where none is given.

/// The step z/omega at the highest frequency omega: of the bands that are declared, else of the first starts
/// of `from`. Where nothing oscillates, z is the part of a thermal momentum sqrt(m kT) that the largest force
/// at these starts adds in a step. Throws std::invalid_argument, in the name of who asks, where there is no
/// force either. Cost: where no bands are declared, some hundred directional derivatives of the force.
double step_of_motion(const model& system, const initial_states& from, double temperature, double z,
                      const std::string& who);

}  // namespace nysalt
