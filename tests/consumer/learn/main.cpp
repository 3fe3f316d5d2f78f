// SPDX-License-Identifier: BSL-1.0
// Learns for the oscillator at the step 1 from two trajectories, which span all others.
// What must come out has a closed form: see examples/linear_oscillator.cpp.
#include "nysalt/learner.hpp"

#include <fmt/format.h>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

int main() {
  using namespace nysalt;
  const harmonic_oscillator system(1.0);
  const vector<double, 1> zero(0.0);
  const vector<double, 1> one(1.0);
  const listed<1> starts({{zero, one}, {one, zero}});
  const auto data = make_flow_map_data(system, starts, exact_linear(system),
                                       {.step = 1.0, .horizon = 1.0, .trajectories = 2});
  const auto fit = learn(nystrom{}, system, data, data, {.coordinates = coordinates::energy});
  for (const auto& p : fit.summary.parameters) fmt::print("{} = {:.4f}\n", p.name, p.value);
}

// Expected output:
// b1 = 0.5000
// beta1 = 0.4006
