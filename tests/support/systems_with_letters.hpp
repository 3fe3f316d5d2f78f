// SPDX-License-Identifier: BSL-1.0
// Systems with letters of their own, that tests step by type and plug-ins declare to the program: parts that
// are quadratic, exponential, and sums; and letters with one slip each.
#pragma once

#include <cmath>

#include "../../examples/systems/bonded_chain.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/systems/textbook.hpp"

namespace lettered {

/// q'' = -q, exactly: linear, and all coordinates alike.
struct turn : nysalt::exact_flow<'t'> {
  template <nysalt::System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos, std::sin;
    const C c = cos(t), s = sin(t);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto q = x.q[i];
      x.q[i] = q * c + x.p[i] * s;
      x.p[i] = x.p[i] * c - q * s;
    }
  }
};
/// The kick with the cubic rest, which leaves q alone.
struct cubic_kick : nysalt::exact_flow<'c'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <nysalt::System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    x.p[0] -= x.q[0] * x.q[1] * 2.0 * t;
    x.p[1] -= (x.q[0] * x.q[0] - x.q[1] * x.q[1]) * t;
  }
};
struct turning : nysalt::henon_heiles {};

/// p^2/2 + exp(q), exactly: exp(-q/2) is a sum of exponentials of the time, whose rate depends on the energy.
struct wall_flow : nysalt::exact_flow<'w'> {
  template <nysalt::System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::exp, std::log, std::sqrt;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto rate = sqrt((x.p[i] * x.p[i] * 0.5 + exp(x.q[i])) * 0.5);
      const auto up = exp(rate * t);
      const auto grows = (up + 1.0 / up) * 0.5;
      const auto turns = (up - 1.0 / up) * 0.5;
      const auto u = exp(x.q[i] * -0.5);
      const auto slope = x.p[i] * u * -0.5;
      const auto end = u * grows + slope / rate * turns;
      x.p[i] = (u * rate * turns + slope * grows) / end * -2.0;
      x.q[i] = log(end) * -2.0;
    }
  }
};
/// The kick of springs, whose stiffness the system says.
struct spring_kick : nysalt::exact_flow<'8'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <class S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] -= x.q[i] * (t * system.stiffness);
  }
};
/// V = sum exp(q_i) + k q_i^2/2, of any size.
struct walls {
  static constexpr int dimension = Eigen::Dynamic;
  long particles = 3;
  double stiffness = 2.0;
  Eigen::Index size() const { return particles; }
  template <class T>
  T potential(const nysalt::vector<T, dimension>& q) const {
    using std::exp;
    T sum(0.0);
    for (Eigen::Index i = 0; i < particles; ++i) sum += exp(q[i]) + q[i] * q[i] * (0.5 * stiffness);
    return sum;
  }
};

/// Stiff bonds and soft charges, a part each.
struct charges : examples::bonded_chain<4> {
  charges() : examples::bonded_chain<4>(examples::stiff_bonds<4>(20.0), examples::soft_charges<4>(2.0)) {}
};

/// The new q goes into the new p.
struct slipped_turn : turn {
  static constexpr char letter = 's';
  template <nysalt::System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos, std::sin;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] = x.q[i] * cos(t) + x.p[i] * sin(t);
      x.p[i] = x.p[i] * cos(t) - x.q[i] * sin(t);
    }
  }
};
/// Symplectic, but -c does not take it back: it turns by an angle that is even in the time.
struct even_turn : turn {
  static constexpr char letter = 'e';
  template <nysalt::System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, C(t + t * t * 0.3), x, room);
  }
};
/// It says that it leaves q alone, and does not.
struct moving_kick : cubic_kick {
  static constexpr char letter = 'm';
  template <nysalt::System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, t, x, room);
  }
};
/// A part of another H.
struct weak_kick : cubic_kick {
  static constexpr char letter = '9';
  template <nysalt::System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    cubic_kick::apply(system, C(t * 0.9), x, room);
  }
};
struct turn_named_a : nysalt::exact_flow<'A'> {
  template <nysalt::System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, t, x, room);
  }
};
/// Without an inverse of its own: not what a declared letter may be.
struct turn_without_back : turn {
  static constexpr bool invertible = false;
};

}  // namespace lettered
