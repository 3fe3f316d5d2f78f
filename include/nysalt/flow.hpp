// SPDX-License-Identifier: BSL-1.0
// An elementary flow: one letter of a method.
#pragma once

#include <concepts>

#include "nysalt/system.hpp"

namespace nysalt {

/// What a letter acts on: q and p, and f, which holds force(q) where the word knows it.
template <Scalar T, int N>
struct flow_state : phase_point<T, N> {
  vector<T, N> f;
};

namespace detail {
/// The least of systems, on which a letter can be tried.
struct free_particle {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>&, vector<double, 1>& f) const { f[0] = 0.0; }
};
}  // namespace detail

/// The flow of an exactly solvable part of the motion over the time c h:
///   letter         its name in words, see docs/notation.md
///   reads_force    f = force(q) must hold when it is applied
///   moves_q        f is stale afterwards
///   additive       the flows over c h and d h compose to that over (c + d) h, so equal neighbours merge
/// and, if it is that of a part of the Hamiltonian,
///   prepare(c, h)  folds the step into the coefficient, once per run
///   apply(system, prepared, state)
/// Such a letter that reads the force may also offer
///   evaluate_and_apply(system, prepared, state)
/// for where the force is not known and no letter reads it afterwards: then it need not be stored in f.
/// The flow of the bath is ornstein_uhlenbeck, whose `stochastic` is true.
template <class L>
concept StochasticFlow = requires {
  requires L::stochastic;
};

template <class L>
concept Flow = requires {
  { L::letter } -> std::convertible_to<char>;
  { L::reads_force } -> std::convertible_to<bool>;
  { L::moves_q } -> std::convertible_to<bool>;
  { L::additive } -> std::convertible_to<bool>;
}
&&(StochasticFlow<L> ||
   requires(flow_state<double, 1> & x) { L::apply(detail::free_particle{}, L::prepare(1.0, 1.0), x); });

}  // namespace nysalt
