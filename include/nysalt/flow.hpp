// SPDX-License-Identifier: BSL-1.0
// An elementary flow: one letter of a method.
#pragma once

#include <concepts>
#include <cstddef>

#include "nysalt/force.hpp"

namespace nysalt {

/// What a letter acts on: q and p, and f, which holds the force that its word reads, where it is known.
template <Scalar T, int N>
struct flow_state : phase_point<T, N> {
  vector<T, N> f;  ///< the force, as its word needs it
};

/// Room for letters that need more than the state: made once a run, so that stepping does not allocate.
template <Scalar T, int N>
struct flow_room : lifted_room<T, N> {
  flow_room() = default;
  /// For so many degrees of freedom.
  explicit flow_room(Eigen::Index size) : lifted_room<T, N>(size), x(size), y(size) {}
  vector<T, N> x;  ///< of a rotation, or M^-1 f of a gradient kick
  vector<T, N> y;  ///< of a rotation, or f'(q) M^-1 f
};

/// The flow of the bath: its `stochastic` is true, and it draws noise.
template <class L>
concept StochasticFlow = requires {
  requires L::stochastic;
};

/// The flow of a part that is quadratic: it is prepared with the modes of the system.
template <class L>
concept QuadraticFlow = requires {
  requires L::reads_modes;
};

namespace detail {
/// The least of systems, on which a letter can be tried.
struct free_particle {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>&, vector<double, 1>& f) const { f[0] = 0.0; }
};

template <class L>
concept AppliedFlow = requires(flow_state<double, 1>& x, flow_room<double, 1>& room) {
  L::apply(free_particle{}, L::prepare(1.0, 1.0), x, room);
}
|| requires(flow_state<double, 1>& x, flow_room<double, 1>& room) {
  L::apply(free_particle{}, L::prepare(1.0, 1.0, 1.0), x, room);
};
}  // namespace detail

/// The flow of an exactly solvable part of the motion over the time c h:
///   letter             its name in words, see docs/notation.md
///   slots              how many coefficients it has
///   reads              the force that must be known, in f, when it is applied
///   force_derivatives  how many f'(q) v it evaluates itself
///   moves_q            f is stale afterwards
///   additive           the flows over c h and d h compose to that over (c + d) h without an evaluation, so
///                      that equal neighbours merge
/// and, if it is that of a part of the Hamiltonian,
///   serves<S, T>                     whether it exists for a system over a scalar
///   prepare(c, h), prepare(b, c, h) of two slots, prepare<N>(c, h, part) of a QuadraticFlow
///                                    fold the step into the coefficients, once per run
///   apply(system, prepared, state, room)
/// Such a letter that reads the force may also offer
///   evaluate_and_apply(system, prepared, state, room)
/// for where the force is not known and no letter reads it afterwards: then it need not be stored in f.
/// The flow of the bath is ornstein_uhlenbeck, whose `stochastic` is true.
template <class L>
concept Flow = requires {
  { L::letter } -> std::convertible_to<char>;
  { L::slots } -> std::convertible_to<std::size_t>;
  { L::reads } -> std::convertible_to<field>;
  { L::force_derivatives } -> std::convertible_to<int>;
  { L::moves_q } -> std::convertible_to<bool>;
  { L::additive } -> std::convertible_to<bool>;
  { L::template serves<detail::free_particle, double> } -> std::convertible_to<bool>;
}
&&(StochasticFlow<L> || QuadraticFlow<L> || detail::AppliedFlow<L>);

}  // namespace nysalt
