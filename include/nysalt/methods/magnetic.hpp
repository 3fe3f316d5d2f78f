// SPDX-License-Identifier: BSL-1.0
// Methods for a charged particle in a uniform magnetic field.
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/cyclotron.hpp"
#include "nysalt/flows/exact_flow.hpp"

namespace nysalt {

/// Half a step straight on, half an electric kick, Boris' turn, half a kick, half a step straight on. Order
/// 2, one electric force; it keeps volume, but is not symplectic. Source: [boris_1970; qin_and_others_2013].
struct boris {
  using word = nysalt::word<velocity_drift, kick_of_part<0>, boris_turn, kick_of_part<0>, velocity_drift>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "boris"; }
  static std::array<double, 5> coefficients() { return {0.5, 0.5, 1.0, 0.5, 0.5}; }
};

/// Half a helix, an electric kick, half a helix: symplectic, of order 2, one electric force, and exact
/// without an electric field.
struct cyclotron_verlet {
  using word = nysalt::word<cyclotron_flow, kick_of_part<0>, cyclotron_flow>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "cyclotron_verlet"; }
  static std::array<double, 3> coefficients() { return {0.5, 1.0, 0.5}; }
};

}  // namespace nysalt
