// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// A(1/2) G(1, 1/24) A(1/2), position Verlet with a gradient kick: order 2, and of effective order 4, as a
/// change of coordinates that is small as h^2 makes it a method of order 4 [takahashi_imada_1984]. Two
/// evaluations.
struct takahashi_imada {
  using word = nysalt::word<drift, gradient_kick, drift>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "takahashi_imada"; }
  static constexpr std::array<double, 4> coefficients() { return {0.5, 1.0, 1.0 / 24.0, 0.5}; }
};

}  // namespace nysalt
