// SPDX-License-Identifier: BSL-1.0
// What a trajectory costs.
#pragma once

#include <algorithm>
#include <cstdint>

#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/counted.hpp"

namespace nysalt {

/// Force evaluations of one whole trajectory of `steps` steps, start-up included: counted over the first two,
/// as every step after them costs the same.
template <SeparableSystem S, Method M>
std::int64_t evaluations_of_run(const S& system, const M& method, double step, std::int64_t steps,
                                const phase_point<double, S::dimension>& start) {
  if constexpr (ErasedSystem<S>) {
    if (!is_black_box(system)) {
      run_time_word word = run_time_word(word_of(method));
      if (!system.bath().acts()) word = conservative_part(word);
      return detail::evaluations_of(system, word.evaluations_to_open + steps * word.evaluations_per_step,
                                    steps * word.force_derivatives);
    }
    const S watched = system.separate();
    const auto stepper = make_stepper(watched, method, step, counter_noise(0));
    auto run = stepper.open(start);
    std::int64_t before_last = watched.calls();
    for (std::int64_t n = 0; n < std::min<std::int64_t>(steps, 2); ++n) {
      before_last = watched.calls();
      stepper.advance(run, 1);
    }
    return watched.calls() + std::max<std::int64_t>(steps - 2, 0) * (watched.calls() - before_last);
  } else {
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
}

}  // namespace nysalt
