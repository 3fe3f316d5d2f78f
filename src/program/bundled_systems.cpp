// SPDX-License-Identifier: BSL-1.0
#include "bundled_systems.hpp"

namespace nysalt::program {

// Each in its file below systems/.
system_declaration declare_fpu();
system_declaration declare_oscillator();
system_declaration declare_linear_chain();
system_declaration declare_pendulum();
system_declaration declare_henon_heiles();
system_declaration declare_kepler();
system_declaration declare_lennard_jones();
system_declaration declare_lennard_jones_liquid();
system_declaration declare_phi4();
system_declaration declare_phi4_lattice();
system_declaration declare_gaussian();
system_declaration declare_logistic_regression();

const std::vector<system_declaration>& bundled_declarations() {
  static const std::vector<system_declaration> all = [] {
    std::vector<system_declaration> declared{declare_fpu(),           declare_oscillator(),
                                             declare_linear_chain(),  declare_pendulum(),
                                             declare_henon_heiles(),  declare_kepler(),
                                             declare_lennard_jones(), declare_lennard_jones_liquid(),
                                             declare_phi4(),          declare_phi4_lattice(),
                                             declare_gaussian(),      declare_logistic_regression()};
    for (auto& system : declared) system.is_checked = true;
    return declared;
  }();
  return all;
}

}  // namespace nysalt::program
