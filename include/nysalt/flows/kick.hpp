// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/flow.hpp"

namespace nysalt {

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
  template <System S, Scalar T>
  static constexpr void require_served() {
    detail::require_quadratic_part<serves<S, T>>();
  }

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

/// B: the flow of V(q).
using kick = kick_of<field::whole>;
/// S: that of V without its quadratic part, whose flow is a rotation.
using soft_kick = kick_of<field::soft>;

}  // namespace nysalt
