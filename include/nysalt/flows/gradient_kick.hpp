// SPDX-License-Identifier: BSL-1.0
// Kicks with the derivative of the force: the letter G, and the letter D, which displaces positions instead.
#pragma once

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

namespace detail {

/// Coefficients of a displaced kick with the step folded in.
template <Scalar C>
struct displaced_kick_coefficients {
  C of_f{0.0};          ///< b h
  C displacement{0.0};  ///< c h^2
};

}  // namespace detail

/// D: a kick with the force at a displaced point, with two coefficients:
///   p += b h f(q + c h^2 M^-1 f(q)),   f = -grad V.
/// The gradient kick G(b, b c/2) up to terms of h^5, without a derivative of the force: two evaluations, of a
/// black box too. Volume-preserving and reversible, but not symplectic unless f is linear:
/// it suits Metropolis' rule, which requires volume and reversibility only. For quadratic K. Source:
/// [yin_mawhinney_2011; schaefers_finkenrath_guenther_knechtli_2024].
struct displaced_kick {
  static constexpr char letter = 'D';
  static constexpr std::size_t slots = 2;
  static constexpr int power_of_second = 2;
  static constexpr field reads = field::whole;
  static constexpr int force_derivatives = 0;
  static constexpr int displaced_forces = 1;
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;
  static constexpr splitting splits = splitting::kinetic_and_potential;
  static constexpr bool symplectic = false;
  static constexpr bool invertible = false;  // the inverse has -b and the same c
  using same_order_as = displaced_kick;
  static constexpr const char* needs = "the letter D needs a quadratic kinetic energy";

  template <System S, Scalar T>
  static constexpr bool serves = HasQuadraticKinetic<S>;

  template <Scalar C>
  static detail::displaced_kick_coefficients<C> prepare(const C& b, const C& c, double h) {
    return {b * h, c * (h * h)};
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const detail::displaced_kick_coefficients<C>& prepared, State& x,
                    auto& room) {
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

namespace detail {

/// Coefficients of a gradient kick with the step folded in.
template <Scalar C>
struct gradient_kick_coefficients {
  C of_f{0.0};             ///< b h
  C of_g{0.0};             ///< 2 c h^3
  double reach_of_v{0.0};  ///< difference step of a black box along M^-1 f: a fraction of h^2
};

/// A kick with the force of b V - c h^2 |grad V|^2 in the metric of M^-1, its second coefficient beside it:
///   p += b h f + 2 c h^3 f'(q) M^-1 f,   f = -grad V or -grad V_soft.
/// [V, [K, V]] depends on q only, so that this is an exact flow too; where a quadratic K is meant
/// [takahashi_imada_1984; chin_1997]. Two evaluations: f'(q) v counts as one, of a black box as two. There it
/// is a difference along h^2 M^-1 f, which is what f moves q by in a step: in any units of any coordinate,
/// and by q only, so that the kick is reversible and keeps volume for any error of the differences.
template <field Field>
struct gradient_kick_of {
  static constexpr char letter = Field == field::soft ? 'H' : 'G';
  static constexpr std::size_t slots = 2;
  static constexpr int power_of_second = 3;
  static constexpr field reads = Field;
  static constexpr int force_derivatives = 1;
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;  // to take it back would cost an evaluation
  static constexpr splitting splits =
      Field == field::soft ? splitting::quadratic_part_and_rest : splitting::kinetic_and_potential;
  static constexpr bool invertible = true;
  using same_order_as = gradient_kick_of<field::whole>;
  static constexpr const char* needs =
      Field == field::soft
          ? detail::needs_quadratic_part
          : "the letter G needs a quadratic kinetic energy, and a force that can be differentiated";

  template <System S, Scalar T>
  static constexpr bool serves =
      Field == field::soft ? HasQuadraticPart<S> && ForceDerivativeOver<S, T, Field>
                           : HasQuadraticKinetic<S> && ForceDerivativeOver<S, T, Field>;

  template <Scalar C>
  static gradient_kick_coefficients<C> prepare(const C& b, const C& c, double h) {
    return {b * h, c * (2.0 * h * h * h), detail::part_of_displacement * h * h};
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const gradient_kick_coefficients<C>& prepared, State& x, auto& room) {
    using T = typename State::scalar_type;
    const auto& [of_f, of_g, reach_of_v] = prepared;
    auto& v = room.x;
    auto& g = room.y;
    velocity<T>(system, x.f, v);
    force_along<Field, T>(system, x.q, v, g, room, reach_of_v);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += x.f[i] * of_f + g[i] * of_g;
  }

  template <class P>
  static void on_oscillator(const auto& stiffness, const double* c, const P& q, P& p) {
    P force = -1.0 * stiffness.template times<Field>(q);
    p += c[0] * force;
    p += -2.0 * c[1] * stiffness.template times<Field>(force);
  }
};

}  // namespace detail

/// G: with the whole force.
using gradient_kick = detail::gradient_kick_of<field::whole>;
/// H: with the force of V without its quadratic part, which commutes with V_soft as all that depends on q
/// does.
using soft_gradient_kick = detail::gradient_kick_of<field::soft>;

}  // namespace nysalt
