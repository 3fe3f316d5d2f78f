// SPDX-License-Identifier: BSL-1.0
// Starts from the invariant law of a system in a bath, by a burn-in that shares nothing with the library's.
#pragma once

#include <cstdint>
#include <vector>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt::test {

/// `count` independent runs from rest, in a bath of the same temperature with friction 1, for a time of 40.
/// The law of q is exact for stiff springs, that of p is narrower by z^2/8, 1 % for a z of .25.
template <NystromSystem S>
listed<S::dimension> thermal_starts(const S& alone, double temperature, int count, std::uint64_t seed) {
  constexpr int lanes = default_lanes;
  using T = pack<double, lanes>;
  const in_bath system(alone, bath::of_temperature(1.0, temperature));
  const auto stepper =
      make_stepper(system, baoab(), 0.005, counter_noise(seed, noise_purpose::initial_state));
  std::vector<phase_point<double, S::dimension>> states;
  while (std::ssize(states) < count) {
    phase_point<T, S::dimension> rest{make_vector<T>(system), make_vector<T>(system)};
    for (Eigen::Index i = 0; i < rest.size(); ++i) rest.q[i] = rest.p[i] = T(0.0);
    auto run = stepper.open(rest, states.size());
    stepper.advance(run, 8000);
    const auto x = stepper.synchronous(run);
    for (int k = 0; k < lanes; ++k) states.push_back(lane(x, k));
  }
  return listed<S::dimension>(std::move(states));
}

}  // namespace nysalt::test
