// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/evaluations.hpp"

#include <algorithm>
#include <stdexcept>

#include "nysalt/detail/conservative_part.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::detail {

std::int64_t evaluations_of_run(const model& system, const tabulated& method, double step, std::int64_t steps,
                                const phase_point<double, Eigen::Dynamic>& start) {
  if (steps < 0)
    throw std::invalid_argument(sentence("evaluations_of_run: steps must not be negative, got {}", steps));
  make_stepper(system, method, step, counter_noise(0));  // refuses what cannot be stepped
  if (!is_black_box(system)) {
    run_time_word word = method.letters();
    if (!system.bath().acts()) word = conservative_part(word);
    if (word.is_processed() && steps == 0) return 0;
    return evaluations_of(
        system, word.evaluations_to_open + steps * word.evaluations_per_step + word.evaluations_to_observe,
        steps * word.force_derivatives);
  }
  const model watched = system.separate();
  const auto stepper = make_stepper(watched, method, step, counter_noise(0));  // any noise
  auto run = stepper.open(start);
  std::int64_t before_last = watched.calls();
  for (std::int64_t n = 0; n < std::min<std::int64_t>(steps, 2); ++n) {
    before_last = watched.calls();
    stepper.advance(run, 1);  // before the first no force may be known
  }
  const std::int64_t more = std::max<std::int64_t>(steps - 2, 0) * (watched.calls() - before_last);
  stepper.synchronous(run);
  return watched.calls() + more;
}

}  // namespace nysalt::detail
