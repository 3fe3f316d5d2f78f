// SPDX-License-Identifier: BSL-1.0
// What a trajectory costs.
#pragma once

#include <algorithm>
#include <cstdint>

#include "nysalt/counted.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// Force evaluations of one whole trajectory of `steps` steps, start-up included: counted over the first two,
/// as every step after them costs the same.
template <SeparableSystem S, Method M>
std::int64_t evaluations_of_run(const S& system, const M& method, double step, std::int64_t steps,
                                const phase_point<double, S::dimension>& start) {
  const counted<S> watched(system);
  const auto stepper = make_stepper(watched, method, step, counter_noise(0));  // whatever noise
  auto run = stepper.open(start);
  std::int64_t before_last = watched.evaluations;
  for (std::int64_t n = 0; n < std::min<std::int64_t>(steps, 2); ++n) {
    before_last = watched.evaluations;
    stepper.advance(run, 1);  // the first may find no force at hand
  }
  const std::int64_t of_a_step = watched.evaluations - before_last;
  return watched.evaluations + std::max<std::int64_t>(steps - 2, 0) * of_a_step;
}

}  // namespace nysalt
