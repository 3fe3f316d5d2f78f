// SPDX-License-Identifier: BSL-1.0
// Your own letter: the exact flow of a part of H, which is stepped, checked and learned like the library's.
//
// Henon's and Heiles' H is two oscillators, whose exact motion is a rotation, and a cubic rest that is small
// near the origin: words of the rotation and of kicks with the rest err by the rest only. (The library has
// letters R and S for quadratic parts; we write our own, as we would for a part that it does not know.)
#include <fmt/format.h>

#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [letter]
/// q'' = -q in each coordinate, exactly.
struct turn : exact_flow<'t'> {
  template <System S, class State, class C>
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
/// The kick with the cubic rest, V_3 = q_1^2 q_2 - q_2^3/3. It evaluates a force, and leaves q unchanged.
struct cubic_kick : exact_flow<'c'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    x.p[0] -= x.q[0] * x.q[1] * 2.0 * t;
    x.p[1] -= (x.q[0] * x.q[0] - x.q[1] * x.q[1]) * t;
  }
};
// [/letter]
/// A slip: the new q goes into the new p.
struct wrong_turn : turn {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      using std::cos, std::sin;
      x.q[i] = x.q[i] * cos(t) + x.p[i] * sin(t);
      x.p[i] = x.p[i] * cos(t) - x.q[i] * sin(t);
    }
  }
};
// [family]
struct turns : symmetric_composition<turn, cubic_kick, 7> {
  static constexpr std::string_view name = "turns";
};
// [/family]

int main() {
  // [system]
  const with_letters<henon_heiles, turn, cubic_kick> system;  // a system declares its letters
  // [/system]
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.1);
  constexpr double step = 1.0;
  // [check]
  const initial_states typical = starts;
  const std::vector points{typical(1, 0), typical(1, 1), typical(1, 2)};
  fmt::print("{}\n", check_letter(system, 't', points, step).report());
  const with_letters<henon_heiles, wrong_turn> wrong;
  fmt::print("{}\n", check_letter(wrong, 't', points, step).report());
  // [/check]
  // [learn]
  const auto reference = fine_steps(0.005);
  const auto data = make_flow_map_data(system, starts, reference, {.step = step, .horizon = 20, .seed = 1});
  const auto unseen = make_flow_map_data(system, starts, reference, {.step = step, .horizon = 20, .seed = 2});
  const fit found = learn(turns{}, system, data, unseen);
  const auto end = integrate(system, found.method, step, starts(3, 0), 1000);
  // [/learn]
  fmt::print("usable: {}; q_1 = {:.4f} after 1000 steps\n",
             found.summary.usable ? "yes" : found.summary.reason, end.finish.q[0]);
  const std::vector methods{found.method.anywhere(), learn(aba<3>{}, system, data, unseen).method.anywhere()};
  const auto errors = trajectory_errors(system, reference, starts, methods, state_measure(system),
                                        {.step = step, .steps = 20, .trajectories = 100, .seed = 3});
  for (std::size_t k = 0; k < methods.size(); ++k)
    fmt::print("  {:<6} state error {:.1e}\n", methods[k].name(), errors.methods[k].error.mean);
}

// Expected output:
// the letter t is what it states
// the letter t is not symplectic: it is off by 4.81e-01; check its formula, or state symplectic = false
// usable: yes; q_1 = 0.0512 after 1000 steps
//   turns  state error 1.3e-03
//   aba3   state error 1.1e-02
