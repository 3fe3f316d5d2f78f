// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// What the symmetric splittings of a Langevin system have in common; one evaluation a step.
struct langevin_splitting {
  static constexpr int order = 2;  // weak; the invariant law's error is of this order too, or better
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
};

/// B(1/2) A(1/2) O A(1/2) B(1/2): exact in the law of q for harmonic systems, on which it is stable for
/// h omega < 2 [leimkuhler_matthews_2013].
struct baoab : langevin_splitting {
  using word = nysalt::word<kick, drift, ornstein_uhlenbeck, drift, kick>;
  static std::string name() { return "baoab"; }
  static constexpr std::array<double, 5> coefficients() { return {0.5, 0.5, 1.0, 0.5, 0.5}; }
};

/// O(1/2) B(1/2) A B(1/2) O(1/2): velocity Verlet between two halves of the bath
/// [bussi_parrinello_2007].
struct obabo : langevin_splitting {
  using word = nysalt::word<ornstein_uhlenbeck, kick, drift, kick, ornstein_uhlenbeck>;
  static std::string name() { return "obabo"; }
  static constexpr std::array<double, 5> coefficients() { return {0.5, 0.5, 1.0, 0.5, 0.5}; }
};

/// A(1/2) B(1/2) O B(1/2) A(1/2) [leimkuhler_matthews_2013].
struct aboba : langevin_splitting {
  using word = nysalt::word<drift, kick, ornstein_uhlenbeck, kick, drift>;
  static std::string name() { return "aboba"; }
  static constexpr std::array<double, 5> coefficients() { return {0.5, 0.5, 1.0, 0.5, 0.5}; }
};

/// Two half steps of BAOAB: what every two-stage method in a bath must beat, at its cost.
struct baoab_2x : langevin_splitting {
  using word =
      nysalt::word<kick, drift, ornstein_uhlenbeck, drift, kick, drift, ornstein_uhlenbeck, drift, kick>;
  static std::string name() { return "baoab_2x"; }
  static constexpr std::array<double, 9> coefficients() {
    return {0.25, 0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.25, 0.25};
  }
};

}  // namespace nysalt
