// SPDX-License-Identifier: BSL-1.0
// The letters A and B.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "nysalt/energy.hpp"
#include "nysalt/flow.hpp"

namespace nysalt {

/// A: the flow of K(p), q += c h grad K(p); with masses q_i += c h p_i / m_i.
struct drift {
  static constexpr char letter = 'A';
  static constexpr std::size_t slots = 1;
  static constexpr field reads = field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = true;
  static constexpr bool additive = true;
  static constexpr splitting splits = splitting::kinetic_and_potential;
  static constexpr bool invertible = true;
  using same_order_as = drift;

  template <System S, Scalar T>
  static constexpr bool serves = true;

  template <Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const C& c, State& x, auto&) {
    using T = typename State::scalar_type;
    const Eigen::Index n = size(system);
    if constexpr (ErasedSystem<S>) {
      if (!system.has_unit_mass() || !has_quadratic_kinetic(system)) {
        return system.template kernels<T>().drift(x.q, x.p, c);
      }
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * c;
    } else if constexpr (HasVelocity<S, double> || HasKineticEnergy<S, double>) {
      auto v = detail::make_vector<T>(system);
      velocity<T>(system, x.p, v);
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += v[i] * c;
    } else if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * (c * system.inverse_mass(i));
    } else {
      for (Eigen::Index i = 0; i < n; ++i) x.q[i] += x.p[i] * c;
    }
  }

  template <class P>
  static void on_oscillator(const auto&, const double* c, P& q, const P& p) {
    q += c[0] * p;
  }
};

namespace detail {

/// The flow of V(q) or of its soft part, p += c h force(q).
template <field Field>
struct kick_of {
  static constexpr char letter = Field == field::soft ? 'S' : 'B';
  static constexpr std::size_t slots = 1;
  static constexpr field reads = Field;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;
  static constexpr splitting splits =
      Field == field::soft ? splitting::quadratic_part_and_rest : splitting::kinetic_and_potential;
  static constexpr bool invertible = true;
  using same_order_as = kick_of<field::whole>;
  static constexpr const char* needs = Field == field::soft ? detail::needs_quadratic_part : "";

  template <System S, Scalar T>
  static constexpr bool serves =
      Field == field::whole || (HasQuadraticPart<S> && ForceOver<S, T, field::soft>);

  template <Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void apply(const S& system, const C& c, State& x, auto&) {
    const Eigen::Index n = size(system);
    for (Eigen::Index i = 0; i < n; ++i) x.p[i] += x.f[i] * c;
  }

  /// Evaluates and applies a force that no other letter needs: by the system's own kick, or with a force that
  /// is at home in registers if its dimension is fixed.
  template <System S, class State, CoefficientOf<typename State::scalar_type> C>
  static void evaluate_and_apply(const S& system, const C& c, State& x, auto& room) {
    using T = typename State::scalar_type;
    if constexpr (Field == field::whole && HasKick<S, T, C>) {
      system.kick(x.q, x.p, c);
    } else if constexpr (S::dimension != Eigen::Dynamic) {
      vector<T, S::dimension> f;
      force_of<Field, T>(system, x.q, f);
      for (Eigen::Index i = 0; i < S::dimension; ++i) x.p[i] += f[i] * c;
    } else {
      force_of<Field, T>(system, x.q, x.f);
      apply(system, c, x, room);
    }
  }

  template <class P>
  static void on_oscillator(const auto& stiffness, const double* c, const P& q, P& p) {
    p += -c[0] * stiffness.template times<Field>(q);
  }
};

}  // namespace detail

/// B: the flow of V(q).
using kick = detail::kick_of<field::whole>;
/// S: the flow of V without its quadratic part, whose flow is a rotation.
using soft_kick = detail::kick_of<field::soft>;

}  // namespace nysalt

// Drifts and kicks in turn, with coefficients that are read in a loop.

namespace nysalt::detail {

/// Which letter of a pair comes first.
enum class pair_begins { with_drift, with_kick };

/// Whether the force of the last kick is stored in the state.
enum class last_force { unknown, stored };

/// `steps` >= 1 times a drift and a kick, or a kick and a drift, for each of `count` pairs of coefficients.
/// The state is a local copy whose address is not taken, so that one of few coordinates stays in registers.
/// The loop over pairs must not be unrolled: g++ would keep the coefficients in registers and spill the
/// state, and take half as long again for six pairs.
template <pair_begins Begins, last_force Last, class T, System S>
[[gnu::always_inline]] inline void take_pairs(const S& system, auto& state, auto& room,
                                              const std::array<double, 2>* pairs, std::size_t count,
                                              std::int64_t steps) {
  constexpr bool stores_force = Last == last_force::stored;
  static_assert(!stores_force || Begins == pair_begins::with_drift);
  constexpr bool moves_force = S::dimension == Eigen::Dynamic;  // the room for it: kicks do not allocate
  flow_state<T, S::dimension> x;
  x.q = std::move(state.q);
  x.p = std::move(state.p);
  if constexpr (moves_force) x.f = std::move(state.f);
  asm("" : "+r"(count));  // a number that is known at compile time is unrolled in spite of the pragma
  for (std::int64_t n = 1; n <= steps; ++n) {
    const std::size_t end = stores_force && n == steps ? count - 1 : count;
#pragma GCC unroll 1
    for (std::size_t i = 0; i < end; ++i) {
      const double first = pairs[i][0];
      const double second = pairs[i][1];
      if constexpr (Begins == pair_begins::with_drift) {
        drift::apply(system, first, x, room);
        kick::evaluate_and_apply(system, second, x, room);
      } else {
        kick::evaluate_and_apply(system, first, x, room);
        drift::apply(system, second, x, room);
      }
    }
  }
  if constexpr (stores_force) {
    const double first = pairs[count - 1][0];
    const double second = pairs[count - 1][1];
    drift::apply(system, first, x, room);
    force_of<field::whole, T>(system, x.q, x.f);
    kick::apply(system, second, x, room);
  }
  state.q = std::move(x.q);
  state.p = std::move(x.p);
  if constexpr (moves_force || stores_force) state.f = std::move(x.f);
}

}  // namespace nysalt::detail
