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

  /// One evaluation; of a black box one more for each direction in which it is differentiated.
  template <class T>
    requires SystemOver<S, T>
  void force(const vector<T, S::dimension>& q, vector<T, S::dimension>& f) const {
    ++evaluations;
    if constexpr (BlackBoxForce<S> && is_dual<T>) evaluations += T::derivatives;  // a directional one each
    nysalt::force<T>(static_cast<const S&>(*this), q, f);
  }

  /// One evaluation.
  template <class T>
    requires HasSoftForce<S, T>
  void soft_force(const vector<T, S::dimension>& q, vector<T, S::dimension>& f) const {
    ++evaluations;
    S::soft_force(q, f);
  }

  /// One evaluation, however a black box comes by it; and two for each direction in which that is
  /// differentiated.
  template <class T>
    requires(HasForceDerivative<S, T> ||
             (BlackBoxForce<S> && (std::is_same_v<T, double> || detail::is_dual_of_double<T>)))
  void force_derivative(const vector<T, S::dimension>& q, const vector<T, S::dimension>& v,
                        vector<T, S::dimension>& g) const {
    ++evaluations;
    if constexpr (HasForceDerivative<S, T>) {
      S::force_derivative(q, v, g);
    } else if constexpr (is_dual<T>) {
      evaluations += 2 * static_cast<std::int64_t>(T::derivatives);
      detail::black_box_along<T>(static_cast<const S&>(*this), q, v, g);
    } else {
      directional_derivative(static_cast<const S&>(*this), q, v, g);
    }
  }

  /// One evaluation.
  template <class T, class C>
    requires HasKick<S, T, C>
  void kick(const vector<T, S::dimension>& q, vector<T, S::dimension>& p, const C& c) const {
    ++evaluations;
    S::kick(q, p, c);
  }

  std::string description() const { return describe(static_cast<const S&>(*this)); }

  mutable std::int64_t evaluations = 0;  ///< so far, by this copy; may be set back
};

}  // namespace nysalt
