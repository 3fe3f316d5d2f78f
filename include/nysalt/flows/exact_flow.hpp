// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/flow.hpp"

namespace nysalt {

/// Default properties of an exact flow of a part of H over the time c h: one coefficient, no
/// force, additive, symplectic, its own inverse with -c, reversible, of every system. A letter of one's own
/// derives from it and adds the map
///   template <System S, class State, class C>
///   static void apply(const S& system, const C& t, State& x, auto& room);     x.q and x.p over the time t =
///   c h
/// over any scalar, and hides what is not so. check_letter() tests each of these claims. The character must
/// be that of no known letter: lower case and digits are free.
template <char Letter>
struct exact_flow {
  static constexpr char letter = Letter;
  static constexpr std::size_t slots = 1;
  static constexpr field reads = field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = true;
  static constexpr bool additive = true;
  static constexpr bool symplectic = true;
  static constexpr bool invertible = true;
  static constexpr bool reversible =
      true;  ///< reversibility with R(q, p) = (q, -p): R flow R flow is the identity

  template <System S, Scalar T>
  static constexpr bool serves = true;

  /// The time t = c h.
  template <Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }
};

}  // namespace nysalt
