// SPDX-License-Identifier: BSL-1.0
// Which names of members a system has, whatever the members are: also overloads, templates and what is not
// const. And which names are near to those that the library uses, so that a member of such a name is taken
// for a mistake: usual synonyms, a letter left out, two letters exchanged.
#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "nysalt/bath.hpp"

namespace nysalt::detail {

// clang-format off
#define NYSALT_USED_MEMBERS(X) \
  X(potential) X(force) X(soft_force) X(force_derivative) X(kick) X(inverse_mass) X(kinetic_energy) \
  X(velocity) X(modes) X(has_modes) X(frequency_bands) X(force_cost) X(bath) X(description) X(kind)
#define NYSALT_NEAR_INVERSE_MASS(X) \
  X(mass) X(masses) X(inverse_masses) X(inv_mass) X(inverseMass) X(mass_matrix) X(inverse_mass_matrix) \
  X(nverse_mass) X(iverse_mass) X(inerse_mass) X(invrse_mass) X(invese_mass) X(invere_mass) \
  X(invers_mass) X(inversemass) X(inverse_ass) X(inverse_mss) X(inverse_mas) X(niverse_mass) \
  X(ivnerse_mass) X(inevrse_mass) X(invrese_mass) X(invesre_mass) X(inveres_mass) X(invers_emass) \
  X(inversem_ass) X(inverse_amss) X(inverse_msas)
#define NYSALT_NEAR_KINETIC_ENERGY(X) \
  X(kinetic) X(kinetic_energies) X(kineticEnergy) X(kinetic_part) X(inetic_energy) X(knetic_energy) \
  X(kietic_energy) X(kintic_energy) X(kineic_energy) X(kinetc_energy) X(kineti_energy) X(kineticenergy) \
  X(kinetic_nergy) X(kinetic_eergy) X(kinetic_enrgy) X(kinetic_enegy) X(kinetic_enery) X(kinetic_energ) \
  X(iknetic_energy) X(knietic_energy) X(kientic_energy) X(kinteic_energy) X(kineitc_energy) \
  X(kinetci_energy) X(kineti_cenergy) X(kinetice_nergy) X(kinetic_neergy) X(kinetic_eenrgy) \
  X(kinetic_enregy) X(kinetic_enegry) X(kinetic_eneryg)
#define NYSALT_NEAR_VELOCITY(X) \
  X(velocities) X(grad_kinetic_energy) X(kinetic_gradient) X(elocity) X(vlocity) X(veocity) X(velcity) \
  X(veloity) X(velocty) X(velociy) X(velocit) X(evlocity) X(vleocity) X(veolcity) X(velcoity) \
  X(veloicty) X(veloctiy) X(velociyt)
#define NYSALT_NEAR_HAMILTONIAN(X) \
  X(hamiltonian) X(Hamiltonian) X(hamilton) X(total_energy) X(energy) X(energies)
#define NYSALT_NEAR_POTENTIAL(X) \
  X(potentials) X(potential_energy) X(potentialEnergy) X(energy_potential) X(otential) X(ptential) \
  X(poential) X(potntial) X(potetial) X(potenial) X(potental) X(potentil) X(potentia) X(optential) \
  X(ptoential) X(poetntial) X(potnetial) X(potetnial) X(potenital) X(potentail) X(potentila)
#define NYSALT_NEAR_FORCE(X) \
  X(forces) X(grad) X(gradient) X(gradients) X(grad_potential) X(potential_gradient) \
  X(gradient_of_potential) X(acceleration) X(accelerations) X(orce) X(frce) X(foce) X(fore) X(forc) \
  X(ofrce) X(froce) X(focre) X(forec)
#define NYSALT_NEAR_OTHERS(X) \
  X(force_derivatives) X(derivative_of_force) X(soft_forces) X(kicks) X(normal_modes) X(mode) \
  X(frequency_band) X(frequencies) X(force_costs) X(cost_of_force) X(describe) X(descriptions) X(kinds) \
  X(baths)
// clang-format on
#define NYSALT_NEAR_MEMBERS(X)  \
  NYSALT_NEAR_INVERSE_MASS(X)   \
  NYSALT_NEAR_KINETIC_ENERGY(X) \
  NYSALT_NEAR_VELOCITY(X)       \
  NYSALT_NEAR_HAMILTONIAN(X) NYSALT_NEAR_POTENTIAL(X) NYSALT_NEAR_FORCE(X) NYSALT_NEAR_OTHERS(X)

/// Members of the names. In a class that derives from this and from S, a name that S has too is ambiguous.
struct named_members {
#define NYSALT_MEMBER(name) int name;
  NYSALT_USED_MEMBERS(NYSALT_MEMBER)
  NYSALT_NEAR_MEMBERS(NYSALT_MEMBER)
#undef NYSALT_MEMBER
};
template <class S>
struct beside_named_members : S, named_members {};
/// Nothing derives from a final class: there only what is neither overloaded nor a template is seen.
template <class S>
  requires(std::is_final_v<S> || std::is_union_v<S>)
struct beside_named_members<S>;
/// In which the name of the class S is a type: in S itself it may be the constructor.
template <class S>
struct deriving : S {};
template <class S>
  requires(std::is_final_v<S> || std::is_union_v<S>)
struct deriving<S>;

// NYSALT_LACKS(S, name): S has no member of the name; the name of a class is none.
#define NYSALT_LACKS(S, name)                                                                     \
  (                                                                                               \
      requires { &beside_named_members<S>::name; } || requires { typename deriving<S>::name; } || \
      (                                                                                           \
          !requires { sizeof(beside_named_members<S>); } && !requires { &S::name; }))

#define NYSALT_MENTIONS(name) \
  template <class S>          \
  inline constexpr bool mentions_##name = !NYSALT_LACKS(S, name);
NYSALT_USED_MEMBERS(NYSALT_MENTIONS)
#undef NYSALT_MENTIONS

// What is public data is a parameter or room, unless it can be the masses: of these a number alone may be of
// another meaning.
#define NYSALT_NO_MASS(name) \
  &&(NYSALT_LACKS(S, name) || requires { requires std::is_arithmetic_v<decltype(S::name)>; })
#define NYSALT_NO_FUNCTION(name) \
  &&(NYSALT_LACKS(S, name) ||    \
     requires { requires std::is_object_v<std::remove_reference_t<decltype(S::name)>>; })
template <class S>
inline constexpr bool mentions_masses = !(true NYSALT_NEAR_INVERSE_MASS(NYSALT_NO_MASS));
template <class S>
inline constexpr bool mentions_near_kinetic_energy = !(true NYSALT_NEAR_KINETIC_ENERGY(NYSALT_NO_FUNCTION));
template <class S>
inline constexpr bool mentions_near_velocity = !(true NYSALT_NEAR_VELOCITY(NYSALT_NO_FUNCTION));
template <class S>
inline constexpr bool mentions_hamiltonian = !(true NYSALT_NEAR_HAMILTONIAN(NYSALT_NO_FUNCTION));
template <class S>
inline constexpr bool mentions_near_potential = !(true NYSALT_NEAR_POTENTIAL(NYSALT_NO_FUNCTION));
template <class S>
inline constexpr bool mentions_near_force = !(true NYSALT_NEAR_FORCE(NYSALT_NO_FUNCTION));
template <class S>
inline constexpr bool mentions_near_others = !(true NYSALT_NEAR_OTHERS(NYSALT_NO_FUNCTION));

#undef NYSALT_NO_MASS
#undef NYSALT_NO_FUNCTION
#undef NYSALT_LACKS
#undef NYSALT_USED_MEMBERS
#undef NYSALT_NEAR_INVERSE_MASS
#undef NYSALT_NEAR_KINETIC_ENERGY
#undef NYSALT_NEAR_VELOCITY
#undef NYSALT_NEAR_HAMILTONIAN
#undef NYSALT_NEAR_POTENTIAL
#undef NYSALT_NEAR_FORCE
#undef NYSALT_NEAR_OTHERS
#undef NYSALT_NEAR_MEMBERS

}  // namespace nysalt::detail

// What a system must not get wrong, said in words. A member that is misspelt in its name or signature would
// be ignored in silence, and the system would be another one.

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

/// Compiles if S can be stepped, and every optional member
/// that it has is one that the library will use; else a static assertion says what is wrong.
template <class S>
constexpr void require_suited() {
  static_assert(System<S>,
                "nysalt: a system is copyable and has `static constexpr int dimension`, positive, or "
                "Eigen::Dynamic with a `size()`");
  static_assert(
      SeparableSystem<S>,
      "nysalt: a separable system offers `template <class T> T potential(q)`, or `force(q, f)` as a "
      "template or over double, const all of them; see nysalt/system.hpp");
  if constexpr (SeparableSystem<S>) {
    using written = typename detail::written_system<S>::type;
    detail::require_used_members<written>();
    detail::require_no_near_members<written>();
    detail::require_no_near_members<S>();  // what derives from a sum of parts may have members of its own
  }
}

}  // namespace nysalt
