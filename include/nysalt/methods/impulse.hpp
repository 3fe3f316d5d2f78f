// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// S(1/2) R S(1/2): velocity Verlet with the quadratic part solved exactly, for systems that declare one
/// [grubmueller_heller_windemuth_schulten_1991; tuckerman_berne_martyna_1992, r-RESPA]. Order 2, one
/// evaluation of the soft force. The step is not limited by the stiff frequencies omega, but resonates with
/// them where h omega is near a multiple of pi.
struct impulse : palindromic<soft_kick, rotation, 3> {
  static constexpr int order = 2;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "impulse"; }
  static constexpr std::array<double, 3> coefficients() { return palindrome<3>({}); }
};

}  // namespace nysalt
