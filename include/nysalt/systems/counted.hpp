// SPDX-License-Identifier: BSL-1.0
// Cost is counted while running, never typed.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "nysalt/force.hpp"

namespace nysalt {

/// A system that counts its force evaluations; everything else is the wrapped system's.
/// Not for several threads at once: each thread counts with its own copy.
template <System S>
  requires(!std::is_final_v<S>)
struct counted : S {
  explicit counted(const S& system) : S(system) {}  ///< counts from 0

  /// Counts one evaluation. Of a black box it is over double only, so that each call that differences make
  /// counts.
  template <class T>
    requires(BlackBoxForce<S> ? std::is_same_v<T, double> : SystemOver<S, T>)
  void force(const vector<T, S::dimension>& q, vector<T, S::dimension>& f) const {
    ++evaluations;
    nysalt::force<T>(static_cast<const S&>(*this), q, f);
  }

  /// Counts one evaluation.
  template <class T>
    requires HasSoftForce<S, T>
  void soft_force(const vector<T, S::dimension>& q, vector<T, S::dimension>& f) const {
    ++evaluations;
    S::soft_force(q, f);
  }

  /// Counts one evaluation.
  template <class T>
    requires HasForceDerivative<S, T>
  void force_derivative(const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                        vector<T, S::dimension>& g) const {
    ++evaluations;
    S::force_derivative(q, v, g);
  }

  /// Counts one evaluation.
  template <class T, class C>
    requires HasKick<S, T, C>
  void kick(const vector<T, S::dimension>& q, vector<T, S::dimension>& p, const C& c) const {
    ++evaluations;
    S::kick(q, p, c);
  }

  std::string description() const { return describe(static_cast<const S&>(*this)); }

  mutable std::int64_t evaluations = 0;  ///< so far, by this copy; may be set back
};

namespace detail {
template <class S>
struct written_system<counted<S>> : written_system<S> {};
}  // namespace detail

}  // namespace nysalt
