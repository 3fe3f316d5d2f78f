// SPDX-License-Identifier: BSL-1.0
// Your own family of methods in a dozen lines.
//
// The largest family of the library with gradient kicks has one of them, between two plain ones. What if
// there are two, and nothing else: A(a) G(1/2, c) A(1 - 2a) G(1/2, c) A(a)? We write the word, a name, where
// a search begins, and the coefficients; the library learns a and c for the Henon-Heiles system, at a step
// that is small and at one that is not. It begins at two half steps of drift-kick-drift, a = 1/4 and c = 0.
// At the small step learning finds the member of order 4, a = (1 - 1/sqrt 3)/2 and c = (2 - sqrt 3)/48.
#include <fmt/format.h>

#include <vector>

#include "nysalt/learn.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [family]
struct two_gradients : composition<2> {
  static constexpr word letters{"AGAGA"};
  static constexpr std::string_view name = "two_gradients";
  static constexpr int order = 2;  // as of all palindromes whose coefficients sum to one
  static constexpr bool symmetric = true;
  static std::array<double, 2> start() { return {0.25, 0.0}; }
  template <Scalar C>
  static std::array<C, 7> coefficients(const std::array<C, 2>& theta) {
    const auto& [a, c] = theta;
    return {a, C(0.5), c, C(1.0) - a * 2.0, C(0.5), c, a};
  }
};
// [/family]

int main() {
  const henon_heiles system;
  const phase_point<double, 2> rest{{0.0, 0.0}, {0.0, 0.0}};
  const normal_around<2> starts(rest, 0.1, 0.1);
  const auto reference = fine_steps(0.005);

  for (const double step : {0.2, 1.0}) {
    const data_options training{.step = step, .horizon = 20 * step, .seed = 1};
    const data_options others{.step = step, .horizon = 20 * step, .seed = 2};
    const auto data = make_flow_map_data(system, starts, reference, training);
    const auto unseen = make_flow_map_data(system, starts, reference, others);
    const fit found = learn(two_gradients{}, system, data, unseen);
    fmt::print("step {}: a = {:.4f}, c = {:.5f}, usable: {}\n", step, found.theta[0], found.theta[1],
               found.summary.usable ? "yes" : found.summary.reason);

    const auto rival = learn(fg4{}, system, data, unseen);
    const std::vector<method> methods{found.method.anywhere(), rival.method.anywhere(), pefrl{}};
    const auto errors = trajectory_errors(system, reference, starts, methods, state_measure(system),
                                          {.step = step, .steps = 20, .trajectories = 100, .seed = 3});
    for (std::size_t k = 0; k < methods.size(); ++k) {
      fmt::print("  {:<14} state error {:.1e}\n", methods[k].name(), errors.methods[k].error.mean);
    }
  }
}

// Expected output:
// step 0.2: a = 0.2115, c = 0.00558, usable: yes
//   two_gradients  state error 2.1e-07
//   fg4            state error 6.6e-08
//   pefrl          state error 4.2e-07
// step 1: a = 0.2158, c = 0.00548, usable: yes
//   two_gradients  state error 2.0e-04
//   fg4            state error 5.8e-05
//   pefrl          state error 3.8e-04
