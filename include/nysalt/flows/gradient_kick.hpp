// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

/// A kick with the force of b V - c h^2 |grad V|^2 in the metric of M^-1, its second coefficient beside it:
///   p += b h f + 2 c h^3 f'(q) M^-1 f,   f = -grad V or -grad V_soft.
/// [V, [K, V]] depends on q alone, so that this is an exact flow too; where a quadratic K is meant
/// [takahashi_imada_1984; chin_1997]. Two evaluations: f'(q) v counts as one.
template <field Field>
struct gradient_kick_of {
  static constexpr char letter = Field == field::soft ? 'H' : 'G';
  static constexpr std::size_t slots = 2;
  static constexpr field reads = Field;
  static constexpr int force_derivatives = 1;
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;  // to take it back would cost an evaluation

  template <System S, Scalar T>
  static constexpr bool serves =
      Field == field::soft ? HasQuadraticPart<S>&& ForceDerivativeOver<S, T, Field>
                           : HasQuadraticKinetic<S>&& ForceDerivativeOver<S, T, Field>;

  template <Scalar C>
  static std::array<C, 2> prepare(const C& b, const C& c, double h) {
    return {b * h, c * (2.0 * h * h * h)};
  }

  template <System S, Scalar T, CoefficientOf<T> C>
  static void apply(const S& system, const std::array<C, 2>& prepared, flow_state<T, S::dimension>& x,
                    flow_room<T, S::dimension>& room) {
    const auto& [of_f, of_g] = prepared;
    auto& v = room.x;
    auto& g = room.y;
    velocity<T>(system, x.f, v);
    force_along<Field, T>(system, x.q, v, g, room);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += x.f[i] * of_f + g[i] * of_g;
  }
};

/// G: with the whole force.
using gradient_kick = gradient_kick_of<field::whole>;
/// H: with that of V without its quadratic part, which commutes with V_soft as all that depends on q does.
using soft_gradient_kick = gradient_kick_of<field::soft>;

}  // namespace nysalt
