// SPDX-License-Identifier: BSL-1.0
// Motion in a uniform magnetic field, exactly and by Boris' steps.
#pragma once

#include <cmath>

#include "nysalt/flows/exact_flow.hpp"

namespace nysalt {

/// A particle in a uniform magnetic field, see systems/charged_particle.hpp: velocities and canonical
/// momenta.
template <class S>
concept HasMagneticField = System<S> && S::dimension == 3 && requires(const S& s) {
  { s.cyclotron_frequency() } -> std::convertible_to<double>;
};

/// m: the exact flow of |v|^2/2 with v = p - A(q): v turns around the field, and q goes along the helix.
/// Symplectic in q and p. With -p it would turn the other way, so that R(q, p) = (q, -p) does not reverse it.
struct cyclotron_flow : exact_flow<'m'> {
  static constexpr bool reversible = false;  ///< false: the field would have to be reversed with p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    const double omega = system.cyclotron_frequency();
    const C c = cos(t * omega);
    const C s = sin(t * omega);
    const C half = sin(t * (0.5 * omega));
    const C along = s * (1.0 / omega);
    const C across = half * half * (2.0 / omega);  // (1 - cos)/omega without cancellation
    auto v = system.velocity_of(x);
    x.q[0] += v[0] * along + v[1] * across;
    x.q[1] += v[1] * along - v[0] * across;
    x.q[2] += v[2] * t;
    const auto first = v[0];
    v[0] = first * c + v[1] * s;
    v[1] = v[1] * c - first * s;
    system.set_velocity(x, v);
  }
};

/// v: q goes straight on with v, which stays. Keeps volume, but is not symplectic: p = v + A(q) changes with
/// q.
struct velocity_drift : exact_flow<'v'> {
  static constexpr bool symplectic = false;
  static constexpr bool reversible = false;  ///< false: R(q, p) = (q, -p) is no reversal,
                                             ///< as v is not p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    const auto v = system.velocity_of(x);
    for (Eigen::Index i = 0; i < 3; ++i) x.q[i] += v[i] * t;
    system.set_velocity(x, v);
  }
};

/// w: v turns around the field by Boris' angle 2 arctan(omega t/2), and q stays: four products and no sine.
/// Keeps volume and |v|, but is not symplectic. Source: [boris_1970].
struct boris_turn : exact_flow<'w'> {
  static constexpr bool moves_q = false;
  static constexpr bool additive = false;
  static constexpr bool symplectic = false;
  static constexpr bool reversible = false;  ///< false: the field would have to be reversed with p

  template <System S, Scalar T>
  static constexpr bool serves = HasMagneticField<S>;

  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    const C half = t * (0.5 * system.cyclotron_frequency());
    const C s = half * 2.0 / (C(1.0) + half * half);
    auto v = system.velocity_of(x);
    const auto first = v[0] + v[1] * half;
    v[1] = v[1] - first * s;
    v[0] = first + v[1] * half;
    system.set_velocity(x, v);
  }
};

}  // namespace nysalt
