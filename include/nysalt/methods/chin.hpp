// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// 4A: B(1/6) A(1/2) G(2/3, 1/72) A(1/2) B(1/6), order 4 without going back in time; three evaluations
/// [chin_1997].
struct chin4a {
  using word = nysalt::word<kick, drift, gradient_kick, drift, kick>;
  static constexpr int order = 4;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "chin4a"; }
  static constexpr std::array<double, 6> coefficients() {
    return {1.0 / 6.0, 0.5, 2.0 / 3.0, 1.0 / 72.0, 0.5, 1.0 / 6.0};
  }
};

}  // namespace nysalt
