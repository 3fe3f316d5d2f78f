// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

/// Coefficients of a displaced kick with the step folded in.
template <Scalar C>
struct displaced_kick_coefficients {
  C of_f{0.0};          ///< b h
  C displacement{0.0};  ///< c h^2
};

/// D: a kick with the force at a displaced point, with two coefficients:
///   p += b h f(q + c h^2 M^-1 f(q)),   f = -grad V.
/// The gradient kick G(b, b c/2) up to terms of h^5, without a derivative of the force: two evaluations, of a
/// black box too. Volume-preserving and reversible, but not symplectic unless f is linear:
/// it suits Metropolis' rule, which requires volume and reversibility only. For quadratic K. Source:
/// [yin_mawhinney_2011; schaefers_finkenrath_guenther_knechtli_2024].
struct displaced_kick {
  static constexpr char letter = 'D';
  static constexpr std::size_t slots = 2;
  static constexpr field reads = field::whole;
  static constexpr int force_derivatives = 0;
  static constexpr int displaced_forces = 1;
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;
  static constexpr splitting splits = splitting::kinetic_and_potential;
  static constexpr bool symplectic = false;
  static constexpr bool invertible = false;  // its inverse is that of -b and the same c
  using same_order_as = displaced_kick;
  static constexpr const char* needs = "the letter D needs a quadratic kinetic energy";

  template <System S, Scalar T>
  static constexpr bool serves = HasQuadraticKinetic<S>;
  template <System S, Scalar T>
  static constexpr void require_served() {
    static_assert(serves<S, T>, "nysalt: the letter D needs a quadratic kinetic energy");
  }

  template <Scalar C>
  static displaced_kick_coefficients<C> prepare(const C& b, const C& c, double h) {
    return {b * h, c * (h * h)};
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const displaced_kick_coefficients<C>& prepared, State& x, auto& room) {
    using T = typename State::scalar_type;
    const auto& [of_f, displacement] = prepared;
    auto& displaced = room.x;
    auto& f = room.y;
    velocity<T>(system, x.f, displaced);
    for (Eigen::Index i = 0; i < x.size(); ++i) displaced[i] = x.q[i] + displaced[i] * displacement;
    force<T>(system, displaced, f);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += f[i] * of_f;
  }

  template <class P>
  static void on_oscillator(const auto& stiffness, const double* c, const P& q, P& p) {
    P displaced = q;
    displaced += -c[1] * stiffness.template times<field::whole>(q);
    p += -c[0] * stiffness.template times<field::whole>(displaced);
  }
};

}  // namespace nysalt
