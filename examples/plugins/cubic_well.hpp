// SPDX-License-Identifier: BSL-1.0
// A system with letters of its own for the program: its words are written by their names, word:tct.
// [system]
#include <nysalt/flows/exact_flow.hpp>
#include <nysalt/plugin.hpp>
#include <nysalt/systems/textbook.hpp>

#include <cmath>
#include <string>

/// Two oscillators and a cubic rest.
struct cubic_well : nysalt::henon_heiles {
  std::string description() const { return "cubic_well()"; }
};
// [/system]

// [letters]
/// q'' = -q in each coordinate, exactly.
struct turn : nysalt::exact_flow<'t'> {
  template <class S, class State, class C>
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
/// The kick with the rest. It evaluates a force, and does not move q.
struct cubic_kick : nysalt::exact_flow<'c'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <class S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    system.soft_force(x.q, room.x);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += room.x[i] * t;
  }
};
// [/letters]

// [declaration]
NYSALT_SYSTEM(cubic_well, "two oscillators, and q_1^2 q_2 - q_2^3/3", letters<turn, cubic_kick>(),
              starts([](const cubic_well&, double spread) {
                return normal_around<2>({{0.0, 0.0}, {0.0, 0.0}}, 0.1 * spread, 0.1 * spread);
              }));
// [/declaration]
