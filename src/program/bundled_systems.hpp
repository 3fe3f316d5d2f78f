// SPDX-License-Identifier: BSL-1.0
// The bundled systems: each is declared in its own file below systems/.
#pragma once

#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// In the order of `list`.
const std::vector<system_declaration>& bundled_declarations();

system_declaration declare_fpu();
system_declaration declare_oscillator();
system_declaration declare_linear_chain();
system_declaration declare_pendulum();
system_declaration declare_henon_heiles();
system_declaration declare_kepler();
system_declaration declare_lennard_jones();
system_declaration declare_phi4();

}  // namespace nysalt::program
