// SPDX-License-Identifier: BSL-1.0
// The bundled systems: each is declared in its own file below systems/.
#pragma once

#include <memory>
#include <vector>

#include "bundled_system.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// What a system is in, and where its trajectories start.
enum class start { law, gibbs, trajectory };
struct surroundings {
  nysalt::bath bath;
  program::start start;
  double spread = 1.0;  // of the law of starts: its deviations are multiplied by it
};

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

/// A chain of three pairs, whose soft springs hold omega^2 at the start.
std::unique_ptr<bundled_system> make_soft_dominated_fpu(double omega);

}  // namespace nysalt::program
