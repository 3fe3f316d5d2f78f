// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "nysalt/families/composition.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/flows/kepler_flow.hpp"

namespace nysalt {

/// Half a kick by the other planets, all planets along their ellipses, half a kick: order 2, symmetric, with
/// an error of the size of the masses of the planets times h^2. One evaluation of the interaction and one
/// Kepler motion of each planet a step, of a solar_system. Source: [wisdom_holman_1991].
struct wisdom_holman {
  using word = nysalt::word<kick_of_part<1>, kepler_flow, kick_of_part<1>>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "wisdom_holman"; }
  static std::array<double, 3> coefficients() { return {0.5, 1.0, 0.5}; }
};

/// The words of Kepler motions and kicks by the other planets in turn that read the same from both ends, with
/// `Kicks` kicks, to learn: Kepler motions first.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct planetary : symmetric_composition<kepler_flow, kick_of_part<1>, 2 * Kicks + 1> {
 private:
  static constexpr detail::numbered_name<11> text{"planetary_", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};
};

}  // namespace nysalt
