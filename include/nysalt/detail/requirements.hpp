// SPDX-License-Identifier: BSL-1.0
// What a system must not get wrong, said in words. A member that is misspelt in its name or signature would
// be ignored in silence, and the system would be another one.
#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "nysalt/bath.hpp"
#include "nysalt/detail/names_of_members.hpp"

namespace nysalt {

namespace detail {

template <class S>
concept TellsDescription = requires(const S& s) {
  { s.description() } -> std::convertible_to<std::string>;
};
template <class S>
concept TellsKind = requires(const S& s) {
  { s.kind() } -> std::convertible_to<std::string>;
};
template <class S>
concept TellsHasModes = requires(const S& s) {
  { s.has_modes() } -> std::same_as<bool>;
};
/// H may have a K that is not p^2/2.
template <class S>
concept TellsKinetic = HasInverseMass<S> || HasKineticEnergy<S, double> || HasVelocity<S, double>;

/// Compiles if every member of a name that the library uses is used.
template <class S>
constexpr void require_used_members() {
  using D = dual<double, 1>;
  static_assert(HasPotential<S, double> || !mentions_potential<S>,
                "nysalt: potential is not of the form `template <class T> T potential(q) const`");
  static_assert(HasForce<S, double> || !mentions_force<S>,
                "nysalt: force is not of the form `template <class T> void force(q, f) const`, which writes "
                "its value into f");
  static_assert(HasSoftForce<S> || !mentions_soft_force<S>,
                "nysalt: soft_force is not of the form `template <class T> void soft_force(q, f) const`");
  static_assert(HasInverseMass<S> || !mentions_inverse_mass<S>,
                "nysalt: inverse_mass is not of the form `double inverse_mass(Eigen::Index i) const`");
  static_assert(HasKineticEnergy<S, double> || !mentions_kinetic_energy<S>,
                "nysalt: kinetic_energy is not of the form `template <class T> T kinetic_energy(p) const`, "
                "as K depends on p alone");
  static_assert(HasVelocity<S, double> || !mentions_velocity<S>,
                "nysalt: velocity is not of the form `template <class T> void velocity(p, v) const`");
  static_assert(!HasVelocity<S, double> || HasVelocity<S, D>,
                "nysalt: velocity(p, v) must be differentiable, and takes double only; make it a template");
  static_assert(
      !HasKineticEnergy<S, double> || HasKineticEnergy<S, D> || HasVelocity<S, D>,
      "nysalt: kinetic_energy(p) must be differentiable, and takes double only; make it a template");
  static_assert(CanDifferentiateForce<S, double> || !mentions_force_derivative<S>,
                "nysalt: force_derivative is not of the form `void force_derivative(q, v, g) const`");
  static_assert(CanKick<S, double, double> || !mentions_kick<S>,
                "nysalt: kick is not of the form `template <class T, class C> void kick(q, p, c) const`");
  static_assert(HasModes<S> || !mentions_modes<S>,
                "nysalt: modes is not of the form `nysalt::normal_modes modes() const`");
  static_assert(TellsHasModes<S> || !mentions_has_modes<S>,
                "nysalt: has_modes is not of the form `bool has_modes() const`");
  static_assert(HasFrequencyBands<S> || !mentions_frequency_bands<S>,
                "nysalt: frequency_bands is not of the form "
                "`std::vector<nysalt::frequency_band> frequency_bands() const`");
  static_assert(HasForceCost<S> || !mentions_force_cost<S>,
                "nysalt: force_cost is not of the form `double force_cost() const`");
  static_assert(
      HasBath<S> || !mentions_bath<S>,
      "nysalt: bath is not of the form `const nysalt::bath& bath() const`; see systems/in_bath.hpp");
  static_assert(TellsDescription<S> || !mentions_description<S>,
                "nysalt: description is not of the form `std::string description() const`");
  static_assert(TellsKind<S> || !mentions_kind<S>,
                "nysalt: kind is not of the form `std::string kind() const`");
}

/// Compiles if no member has a name near to one that the library uses, where that one is missing.
template <class S>
constexpr void require_no_near_members() {
  static_assert(TellsKinetic<S> || !mentions_masses<S>,
                "nysalt: a member of a name such as mass or masses is not used; give masses by "
                "`double inverse_mass(Eigen::Index i) const`, or rename it");
  static_assert(HasKineticEnergy<S, double> || HasVelocity<S, double> || !mentions_near_kinetic_energy<S>,
                "nysalt: a member of a name near to kinetic_energy is not used; write "
                "`template <class T> T kinetic_energy(p) const`, or rename it");
  static_assert(HasVelocity<S, double> || !mentions_near_velocity<S>,
                "nysalt: a member of a name near to velocity is not used; write "
                "`template <class T> void velocity(p, v) const`, or rename it");
  static_assert(
      TellsKinetic<S> || !mentions_hamiltonian<S>,
      "nysalt: a member of a name such as hamiltonian is not used; H is K(p) + V(q), of `potential` "
      "and of `inverse_mass`, `kinetic_energy` or else p^2/2: write these, or rename it");
  static_assert(HasPotential<S, double> || !mentions_near_potential<S>,
                "nysalt: a member of a name near to potential is not used; write "
                "`template <class T> T potential(q) const`, or rename it");
  static_assert(HasForce<S, double> || !mentions_near_force<S>,
                "nysalt: a member of a name near to force or gradient is not used; write "
                "`template <class T> void force(q, f) const`, f = -grad V, or rename it");
  static_assert(
      !mentions_near_others<S> || HasModes<S> || HasFrequencyBands<S> || HasForceCost<S> || HasBath<S>,
      "nysalt: a member of a name near to force_derivative, soft_force, kick, modes, "
      "frequency_bands, force_cost, description, kind or bath is not used; see "
      "docs/concepts/system.md, or rename it");
}

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
  if constexpr (SeparableSystem<S> && !ErasedSystem<S>) {
    using written = typename detail::written_system<S>::type;
    detail::require_used_members<written>();
    detail::require_no_near_members<written>();
    detail::require_no_near_members<S>();  // what derives from a sum of parts may have members of its own
  }
  if constexpr (requires { std::bool_constant<M::requires_quadratic_kinetic>{}; }) {
    static_assert(!M::requires_quadratic_kinetic || NystromSystem<S>,
                  "nysalt: the order of this method needs a quadratic kinetic energy, but the system has a "
                  "kinetic energy of its own; take one of any K(p), as blanes_moan_s10, and as reference "
                  "fine_steps<blanes_moan_s10>");
  }
}

}  // namespace nysalt
