// SPDX-License-Identifier: BSL-1.0
// A method for the harmonic oscillator, from the outside: the component learn alone.
#include "nysalt/learn.hpp"

#include <cstdio>

#include "nysalt/nysalt.hpp"

int main() {
  using namespace nysalt;
  const harmonic_oscillator system(1.0);
  const vector<double, 1> zero(0.0);
  const normal_around<1> starts({zero, zero}, 1.0, 1.0);
  const auto data_of = [&](std::uint64_t seed) {
    return make_flow_map_data(system, starts, fine_steps(1e-2),
                              {.step = 0.5, .horizon = 5.0, .trajectories = 8, .seed = seed});
  };
  const auto [theta, summary, method] = learn(nystrom{}, system, data_of(1), data_of(2));
  std::printf("%s\n", summary.usable ? "usable" : "not usable");
}

// Expected output:
// usable
