// SPDX-License-Identifier: BSL-1.0
// Data that a method made itself, step by step with noise that is told beforehand.
#pragma once

#include <cstdint>
#include <utility>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/along_path.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::test {

struct steps_options {
  double step;
  std::int64_t steps = 10;  // of each trajectory
  std::int64_t trajectories = 30;
  std::uint64_t seed = 1;
  int parts = 2;  // of a step, in which its noise is told
};

/// Noise `parts` times a step, and with it a plain step of the method from each state to the next.
template <class S, Ensemble<S> E, Method M>
flow_map_data made_by_steps(const S& system, const E& ensemble, const M& method,
                            const steps_options& options) {
  using numbers = vector<double, S::dimension>;
  flow_map_data data;
  data.step = options.step;
  data.noise_parts = options.parts;
  data.system = describe(system);
  data.seed = options.seed;
  data.first_of = {0};
  const auto intervals = intervals_of_noise(word_of(method), method.coefficients());
  for (std::int64_t m = 0; m < options.trajectories; ++m) {
    const auto trajectory = static_cast<std::uint64_t>(m);
    recorded_path<double, S::dimension> path(options.step / options.parts, system.bath().friction(),
                                             trajectory);
    for (std::int64_t n = 0; n < options.steps * options.parts; ++n) {
      numbers xi = make_vector<double>(system);
      counter_noise(options.seed).normals(noise_place{trajectory, n, 0}, xi);
      data.noise.push_back(xi);
      path.add(std::move(xi));
    }
    const along_path<double, S::dimension> noise(path, intervals, options.step);
    const auto stepper = make_stepper(system, method, options.step, noise);
    auto x = ensemble(options.seed, trajectory);
    for (std::int64_t n = 0; n < options.steps; ++n) {
      data.start.push_back(x);
      stepper.step(x, trajectory, n);
      data.finish.push_back(x);
    }
    data.first_of.push_back(data.pairs());
  }
  return data;
}

}  // namespace nysalt::test
