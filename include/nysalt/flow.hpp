// SPDX-License-Identifier: BSL-1.0
// An elementary flow: one letter of a method.
#pragma once

#include <concepts>
#include <cstddef>

#include "nysalt/force.hpp"

namespace nysalt {

/// The state that a letter acts on: q and p, and f, which holds the force that its word reads, where it is
/// known.
template <Scalar T, int N>
struct flow_state : phase_point<T, N> {
  vector<T, N> f;  ///< force at q, where the word needs the force
};

namespace detail {

/// Empty work space, of letters that need none.
struct no_room {};

/// Room for letters that need more than the state: made once a run, so that stepping does not allocate.
template <Scalar T, int N>
struct flow_room : lifted_room<T, N> {
  flow_room() = default;
  /// Work space for a number of degrees of freedom.
  explicit flow_room(Eigen::Index size) : lifted_room<T, N>(size), x(size), y(size) {}
  vector<T, N> x;  ///< work space: modal x of a rotation, M^-1 f of a gradient kick, or the displaced q
  vector<T, N> y;  ///< work space: modal y of a rotation, f'(q) M^-1 f, or the force at the displaced q
};

}  // namespace detail

/// The flow of the bath: its `stochastic` is true, and it draws noise.
template <class L>
concept StochasticFlow = requires { requires L::stochastic; };

/// The flow of a part that is quadratic: it is prepared with the modes of the system.
template <class L>
concept QuadraticFlow = requires { requires L::reads_modes; };

/// The splitting of H by the words with this letter; `any` of a letter that belongs to all of them.
enum class splitting {
  any,
  kinetic_and_potential,   ///< K and V: A, B, D, G
  quadratic_part_and_rest  ///< K with the quadratic part of V, and the rest of V: R, S, H
};

namespace detail {

/// The oscillator q'' = -(theta^2 + k) q of which theta^2 is the quadratic part, for letters over a step
/// of 1. times_k(x) is k x, so that k may be a number, the variable of a polynomial, or, for two modes, a
/// matrix; theta is a number, or an array of two.
template <class Theta, class TimesK>
struct split_stiffness {
  const Theta& theta;     ///< frequency of the quadratic part
  const TimesK& times_k;  ///< the rest

  /// Minus the force at x, whole or soft.
  template <field F, class P>
  P times(const P& x) const {
    P result = times_k(x);
    if constexpr (F == field::whole) result += theta * theta * x;
    return result;
  }
};

/// `any` where a letter declares none.
template <class L>
constexpr splitting splitting_of() {
  if constexpr (requires { L::splits; }) {
    return L::splits;
  } else {
    return splitting::any;
  }
}

/// How many forces a letter evaluates itself, at displaced points or of a part; 0 where it declares none.
template <class L>
constexpr int displaced_forces_of() {
  if constexpr (requires { L::displaced_forces; }) {
    return L::displaced_forces;
  } else {
    return 0;
  }
}

/// Whether a letter is symplectic, which it need not declare.
template <class L>
constexpr bool is_symplectic() {
  if constexpr (requires { L::symplectic; }) {
    return L::symplectic;
  } else {
    return true;
  }
}

/// Requirements of R, S and H on a system, for refusals at run time and at compile time.
inline constexpr const char* needs_quadratic_part =
    "the letters R, S, H need a system that declares a quadratic part: modes() and soft_force(q, f), see "
    "nysalt/system.hpp, or with_quadratic_part(system, stiffness); as templates over any scalar, where they "
    "are learned or H is among them";
/// The least of systems, on which a letter can be tried.
struct free_particle {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>&, vector<double, 1>& f) const { f[0] = 0.0; }
};

template <class L>
concept AppliedFlow = requires(flow_state<double, 1>& x, flow_room<double, 1>& room) {
  L::apply(free_particle{}, L::prepare(1.0, 1.0), x, room);
} || requires(flow_state<double, 1>& x, flow_room<double, 1>& room) {
  L::apply(free_particle{}, L::prepare(1.0, 1.0, 1.0), x, room);
} || requires(const double* c, flow_state<double, 1>& x, flow_room<double, 1>& room) {
  L::apply(free_particle{}, L::prepare(c, 1.0), x, room);
};
}  // namespace detail

/// The flow of an exactly solvable part of the motion over the time c h:
///   letter             its name in words, see docs/notation.md
///   slots              how many coefficients it has
///   reads              the force that must be known, in f, when it is applied
///   force_derivatives  how many f'(q) v it evaluates itself
///   moves_q            f is stale afterwards
///   additive           the flows over c h and d h compose to the flow over (c + d) h without an
///                      evaluation, so that equal neighbours merge
/// and, if it is the flow of a part of the Hamiltonian,
///   serves<S, T>                     whether it exists for a system over a scalar
///   prepare(c, h), prepare(b, c, h) of two slots, prepare(const C* c, h) of any number of them,
///   prepare<N>(c, h, part) of a QuadraticFlow
///                                    fold the step into the coefficients, once per run
///   apply(system, prepared, state, room)
/// Such a letter that reads the force may also offer
///   evaluate_and_apply(system, prepared, state, room)
/// for where the force is not known and no letter reads it afterwards: then it need not be stored in f.
/// The flow of the bath is ornstein_uhlenbeck, whose `stochastic` is true. A letter of one's own derives from
/// exact_flow, which states most of this.
///
/// A letter of the library states besides:
///   splits             what its words split H into (`any` if a letter does not say)
///   needs              the sentence for who does not serve it, of letters that not every system serves
///   power_of_second    the power of h that goes with its second coefficient, if it has two
///   invertible         with all coefficients negated it is its inverse
///   displaced_forces   how many forces it evaluates itself, at displaced points or of a part, if any
///   symplectic         false of one that is not
///   same_order_as      the letter of K and V in whose place it obeys the same order conditions
///   on_oscillator(stiffness, c, q, p)   its action on an oscillator, unless it is of the bath
template <class L>
concept Flow = requires {
  { L::letter } -> std::convertible_to<char>;
  { L::slots } -> std::convertible_to<std::size_t>;
  { L::reads } -> std::convertible_to<field>;
  { L::force_derivatives } -> std::convertible_to<int>;
  { L::moves_q } -> std::convertible_to<bool>;
  { L::additive } -> std::convertible_to<bool>;
  { L::template serves<detail::free_particle, double> } -> std::convertible_to<bool>;
} && (StochasticFlow<L> || QuadraticFlow<L> || detail::AppliedFlow<L>);

}  // namespace nysalt
