// SPDX-License-Identifier: BSL-1.0
// A force that you have already: compiled C code, of which we know a pointer in and a pointer out.
//
// It is wrapped in ten lines and learned for as it is. What a template would give is missing: derivatives are
// taken by central differences of the force, and trajectories go one by one, not side by side. That is
// slower, and as exact as learning needs. The library checks that the force belongs to the energy; a wrong
// sign is refused.
#include <fmt/format.h>

#include <stdexcept>

#include "c_force/morse_chain.h"
#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [wrapper]
struct chain_in_c {
  static constexpr int dimension = 3;
  morse_bonds bonds{10.0, 1.0};
  double sign = 1.0;  // for the mistake below

  void force(const vector<double, 3>& q, vector<double, 3>& f) const {
    morse_chain(dimension, q.data(), f.data(), &bonds);
    f *= sign;
  }
  double potential(const vector<double, 3>& q) const {  // for energies, and to check the force
    vector<double, 3> ignored;
    return morse_chain(dimension, q.data(), ignored.data(), &bonds);
  }
  std::string description() const { return fmt::format("morse_chain({}, {})", bonds.depth, bonds.width); }
};
static_assert(BlackBoxForce<chain_in_c>);
// [/wrapper]

int main() {
  const chain_in_c chain;
  const normal_around<3> starts({vector<double, 3>::Zero(), vector<double, 3>::Zero()}, 0.0, 0.25);
  const auto reference = fine_steps(0.01);
  constexpr double step = 0.2;

  // [learn]
  const auto data = make_flow_map_data(chain, starts, reference, {.step = step, .horizon = 4.0, .seed = 1});
  const auto unseen = make_flow_map_data(chain, starts, reference, {.step = step, .horizon = 4.0, .seed = 2});
  const fit found = learn(aba<4>{}, chain, data, unseen);
  // [/learn]
  fmt::print("usable: {}; derivatives by {}\n", found.summary.usable ? "yes" : found.summary.reason,
             found.summary.derivatives);

  // At equal cost: the steps are such that each evaluates the force twenty times in a unit of time.
  const auto report = [&](const method& other, double method_step, std::int64_t evaluations) {
    const auto result =
        trajectory_errors(chain, reference, starts, other, state_measure(chain),
                          {.step = method_step, .steps = 80 / evaluations, .trajectories = 50, .seed = 3});
    fmt::print("{:<8} error of the state after 80 evaluations: {:.1e} +- {:.0e}\n", other.name(),
               result.methods[0].error.mean, result.methods[0].error.standard_error);
  };
  report(found.method.anywhere(), step, 4);
  report(pefrl{}, step, 4);
  report(verlet{}, step / 4, 1);

  // [mistake]
  try {  // grad V instead of -grad V
    chain_in_c wrong;
    wrong.sign = -1.0;
    learn(aba<4>{}, wrong, data, unseen);
  } catch (const std::invalid_argument& refusal) {
    fmt::print("{}\n", refusal.what());
  }
  // [/mistake]
}

// clang-format off
// Expected output:
// usable: yes; derivatives by central differences of the force
// aba4     error of the state after 80 evaluations: 5.0e-04 +- 6e-05
// pefrl    error of the state after 80 evaluations: 1.5e-03 +- 1e-04
// verlet   error of the state after 80 evaluations: 2.2e-02 +- 1e-03
// cannot learn on morse_chain(10, 1): the force is not -grad V: coordinate 3 is off by 2.00e+00 of the largest force; check its sign and formula; mend the system, or learn with check_force = false
