// SPDX-License-Identifier: BSL-1.0
// What a system must not get wrong, said in words. A member that is misspelt in its signature would be
// ignored in silence, and the system would be another one.
#pragma once

#include <type_traits>

#include "nysalt/bath.hpp"

namespace nysalt {

namespace detail {

// There is a member of that name, const or not, with any result.
template <class S, class V = vector<double, S::dimension>>
concept MentionsInverseMass =
    requires { &S::inverse_mass; } || requires(S& s) { s.inverse_mass(Eigen::Index{0}); };
template <class S, class V = vector<double, S::dimension>>
concept MentionsKineticEnergy =
    requires { &S::kinetic_energy; } || requires(S& s, const V& p) { s.kinetic_energy(p); };
template <class S, class V = vector<double, S::dimension>>
concept MentionsVelocity =
    requires { &S::velocity; } || requires(S& s, const V& p, V& v) { s.velocity(p, v); };
template <class S, class V = vector<double, S::dimension>>
concept MentionsForceDerivative =
    requires { &S::force_derivative; } || requires(S& s, const V& q, V& g) { s.force_derivative(q, q, g); };
template <class S, class V = vector<double, S::dimension>>
concept MentionsKick = requires { &S::kick; } || requires(S& s, const V& q, V& p) { s.kick(q, p, 1.0); };
template <class S>
concept MentionsModes = requires { &S::modes; } || requires(S& s) { s.modes(); };
template <class S>
concept MentionsFrequencyBands = requires { &S::frequency_bands; } || requires(S& s) { s.frequency_bands(); };

template <class S>
concept MentionsForceCost = requires { &S::force_cost; } || requires(S& s) { s.force_cost(); };
template <class S>
concept MentionsBath = requires { &S::bath; } || requires(S& s) { s.bath(); };

}  // namespace detail

/// Compiles if S can be stepped by methods of M's kind (a method or a family), and every optional member
/// that it has is one that the library will use; else a static assertion says what is wrong.
template <class M, class S>
constexpr void require_suited() {
  static_assert(System<S>,
                "nysalt: a system is copyable and has `static constexpr int dimension`, positive, or "
                "Eigen::Dynamic with a `size()`");
  static_assert(
      SeparableSystem<S>,
      "nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a "
      "template or over double, const all of them; see nysalt/system.hpp");
  using D = dual<double, 1>;
  static_assert(HasInverseMass<S> || !detail::MentionsInverseMass<S>,
                "nysalt: inverse_mass is not of the form `double inverse_mass(Eigen::Index i) const`");
  static_assert(HasKineticEnergy<S, double> || !detail::MentionsKineticEnergy<S>,
                "nysalt: kinetic_energy is not of the form `template <class T> T kinetic_energy(p) const`");
  static_assert(HasVelocity<S, double> || !detail::MentionsVelocity<S>,
                "nysalt: velocity is not of the form `template <class T> void velocity(p, v) const`");
  static_assert(!HasVelocity<S, double> || HasVelocity<S, D>,
                "nysalt: velocity(p, v) must be differentiable, and takes double only; make it a template");
  static_assert(
      !HasKineticEnergy<S, double> || HasKineticEnergy<S, D> || HasVelocity<S, D>,
      "nysalt: kinetic_energy(p) must be differentiable, and takes double only; make it a template");
  static_assert(detail::CanDifferentiateForce<S, double> || !detail::MentionsForceDerivative<S>,
                "nysalt: force_derivative is not of the form `void force_derivative(q, v, g) const`");
  static_assert(detail::CanKick<S, double, double> || !detail::MentionsKick<S>,
                "nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`");
  static_assert(HasModes<S> || !detail::MentionsModes<S>,
                "nysalt: modes is not of the form `nysalt::normal_modes modes() const`");
  static_assert(HasFrequencyBands<S> || !detail::MentionsFrequencyBands<S>,
                "nysalt: frequency_bands is not of the form "
                "`std::vector<nysalt::frequency_band> frequency_bands() const`");
  static_assert(HasForceCost<S> || !detail::MentionsForceCost<S>,
                "nysalt: force_cost is not of the form `double force_cost() const`");
  static_assert(
      HasBath<S> || !detail::MentionsBath<S>,
      "nysalt: bath is not of the form `const nysalt::bath& bath() const`; see systems/in_bath.hpp");
  if constexpr (requires { std::bool_constant<M::requires_quadratic_kinetic>{}; }) {
    static_assert(!M::requires_quadratic_kinetic || NystromSystem<S>,
                  "nysalt: the order of this method needs a quadratic kinetic energy, but the system has a "
                  "kinetic energy of its own");
  }
}

}  // namespace nysalt
