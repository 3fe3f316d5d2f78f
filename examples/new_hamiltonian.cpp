// SPDX-License-Identifier: BSL-1.0
// Your own Hamiltonian in fifteen lines, through the whole path.
//
// Two atoms of different masses, bound by a Morse potential to a wall and to each other. We write the
// potential and the masses, nothing else: the force comes by automatic differentiation, and the library
// checks it, learns a method for it, and tests what it learned.
#include <fmt/format.h>

#include <cmath>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [system]
struct morse_pair {
  static constexpr int dimension = 2;

  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::exp;
    const T to_wall = 1.0 - exp(-q[0]);
    const T between = 1.0 - exp(q[0] - q[1]);
    return to_wall * to_wall + 2.0 * (between * between);
  }
  std::string description() const { return "morse_pair()"; }
};
static_assert(NystromSystem<morse_pair>);
// [/system]

int main() {
  // [learn]
  const morse_pair system;
  const phase_point<double, 2> rest{{0.0, 0.0}, {0.0, 0.0}};
  const normal_around<2> starts(rest, 0.1, 0.3);
  fmt::print("check: {}\n", check_force(system, {starts(1, 0).q, starts(1, 1).q}).report());

  constexpr double step = 0.4;
  const auto reference = fine_steps(0.01);
  const auto data = make_flow_map_data(system, starts, reference, {.step = step, .horizon = 8.0, .seed = 1});
  const auto held_out =
      make_flow_map_data(system, starts, reference, {.step = step, .horizon = 8.0, .seed = 2});
  const fit found = learn(nystrom{}, system, data, held_out);
  // [/learn]
  fmt::print("b1 = {:.4f}, beta1 = {:.4f}, usable: {}\n", found.theta[0], found.theta[1],
             found.summary.usable ? "yes" : found.summary.reason);
  fmt::print("force derivatives by {}\n\n", found.summary.derivatives);

  const auto start = starts(3, 0);
  fmt::print("symplectic to {}\n",
             symplecticity_defect(system, found.method, step, start) < 1e-13 ? "rounding" : "no degree");
  const auto report = [&](const method& other) {
    const auto energy = energy_drift(system, other, step, start, 2500);
    fmt::print("{:<16} largest relative energy error over 1000 units of time: {:.1e}\n", other.name(),
               energy.largest);
  };
  report(found.method);
  report(mclachlan2{});
  report(verlet_2x{});

  try {  // a learned method knows what it was learned for
    integrate(system, found.method, 2 * step, start, 10);
  } catch (const std::invalid_argument& refusal) {
    fmt::print("\n{}\n", refusal.what());
  }
}

// clang-format off
// Expected output:
// check: the force is -grad V
// b1 = 0.4939, beta1 = 0.3873, usable: yes
// force derivatives by automatic differentiation
//
// symplectic to rounding
// nystrom          largest relative energy error over 1000 units of time: 2.5e-02
// mclachlan2       largest relative energy error over 1000 units of time: 2.4e-02
// verlet_2x        largest relative energy error over 1000 units of time: 5.2e-02
//
// learned:nystrom must run at the step 0.4, at which it was learned, got 0.8; learn it there, or use anywhere()
