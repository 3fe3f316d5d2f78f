// SPDX-License-Identifier: BSL-1.0
// Letters that are exact flows of a part, and kicks with the force of one part.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

/// Default properties of an exact flow of a part of H over the time c h: one coefficient, no
/// force, additive, symplectic, its own inverse with -c, reversible, of every system. A letter of one's own
/// derives from it and adds the map
///   template <System S, class State, class C>
///   static void apply(const S& system, const C& t, State& x, auto& room);     x.q and x.p over the time t =
///   c h
/// over any scalar, and hides what is not so. check_letter() tests each of these claims. The character must
/// be the name of no known letter: lower case and digits are free. The system declares its letters as
/// `using letters = std::tuple<...>`, or is wrapped in with_letters.
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

// Kicks with the forces of parts of V.

/// A system that is a sum of parts: part<I>() is a system with the force of V_i, see
/// flows/sum_of_parts.hpp.
template <class S>
concept HasParts = System<S> && requires(const S& s) {
  { S::parts } -> std::convertible_to<std::size_t>;
  s.template part<0>();
};

/// The flow of c_I V_I + c_J V_J + ..., p += h (c_I force_I(q) + c_J force_J(q) + ...), one coefficient for
/// each part: the kicks commute, so that they are one letter, which merges with the next step's. Named k, or
/// with one part I by the digit I: '0', '1', ... Cost: an evaluation of each of its parts.
template <std::size_t... Part>
  requires(sizeof...(Part) > 0 && ((Part < 10) && ...))
struct kick_of_parts : exact_flow<sizeof...(Part) == 1 ? static_cast<char>('0' + std::max({Part...})) : 'k'> {
  static constexpr std::size_t slots = sizeof...(Part);
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = static_cast<int>(sizeof...(Part));
  static constexpr std::array<char, sizeof...(Part)> digits{
      static_cast<char>('0' + Part)...};  ///< numbers of the parts
  /// The part whose time each coefficient is, a digit for each.
  static constexpr std::string_view times{digits.data(), digits.size()};

  /// Number of evaluations of the force of a part: 0 or 1.
  static constexpr int evaluations_of_part(std::size_t part) { return (0 + ... + (part == Part ? 1 : 0)); }

  template <System S, Scalar T>
  static constexpr bool serves = HasParts<S>;

  template <Scalar C>
  static std::array<C, slots> prepare(const C* c, double h) {
    std::array<C, slots> result;
    for (std::size_t k = 0; k < slots; ++k) result[k] = c[k] * h;
    return result;
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const std::array<C, slots>& c, State& x, auto& room) {
    using T = typename State::scalar_type;
    const auto kick = [&](const auto& part, const C& by) {
      force<T>(part, x.q, room.x);
      for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += room.x[i] * by;
    };
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      (kick(system.template part<Part>(), c[K]), ...);
    }(std::make_index_sequence<slots>());
  }
};

/// The flow of the part V_I, named by the digit I.
template <std::size_t Part>
using kick_of_part = kick_of_parts<Part>;

namespace detail {

/// The kicks of each of `Parts` parts alone, and of all of them together: the letters of a sum of parts.
template <class Parts>
struct kicks_of;
template <std::size_t... Part>
struct kicks_of<std::index_sequence<Part...>> {
  using type = std::tuple<kick_of_part<Part>..., kick_of_parts<Part...>>;
};
template <>
struct kicks_of<std::index_sequence<0>> {
  using type = std::tuple<kick_of_part<0>>;
};

}  // namespace detail

}  // namespace nysalt
