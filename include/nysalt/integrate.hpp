// SPDX-License-Identifier: BSL-1.0
// One trajectory from start to finish, watched over.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "nysalt/core/sentence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/stepping/lockstep.hpp"

namespace nysalt {

/// End of a trajectory. Where it diverged, `finish` is the state at that step.
template <int N>
struct outcome {
  phase_point<double, N> finish;            ///< the last state
  std::int64_t steps = 0;                   ///< number of steps taken
  std::optional<std::int64_t> diverged_at;  ///< the first bad step; nothing where all went well
};

/// Takes `steps` steps of a stepper from start, with the noise of that trajectory. The observer is called as
/// observer(n, t, state) with t = n h at n = 0, every, 2 every, ...; what it sees is synchronous, and looking
/// does not change the run.
///
/// Divergence is checked every 64 steps and at the end, for any observer. Where it is found, these steps are
/// taken again to name the first bad step, and no observer sees that step or a later one. Steps between two
/// checks are also taken twice if samples lie among them: samples are shown when the second check is known to
/// be good. Cost: the steps, up to twice as many where samples are less than 64 steps apart.
/// Near the edge of a stability window a bounded motion can swing beyond the criterion and back: that counts
/// if it is beyond at a check.
/// Throws std::invalid_argument if steps < 0, every < 1 or the start is not finite or does not fit.
template <class Stepper, class Observer>
outcome<Stepper::dimension> integrate(const Stepper& stepper,
                                      const phase_point<double, Stepper::dimension>& start,
                                      std::int64_t steps, Observer&& observer, std::int64_t every,
                                      std::uint64_t trajectory = 0) {
  if (steps < 0 || every < 1) {
    throw std::invalid_argument(
        sentence("integrate: steps must be >= 0 and every >= 1, got steps {} and every {}", steps, every));
  }
  if (start.q.size() != size(stepper.system()) || start.p.size() != start.q.size() || !is_finite(start)) {
    throw std::invalid_argument("integrate: the start must be finite and have the system's dimension");
  }
  detail::lockstep<Stepper, double> run(stepper, start, 1, static_cast<std::int64_t>(trajectory));
  const auto show = [&](std::int64_t n, const auto& x) {
    observer(n, static_cast<double>(n) * stepper.step_size(), x);
  };
  show(0, start);
  while (run.step() < steps && !run.diverged_at(0)) {
    const std::int64_t next_sample = (run.step() / every + 1) * every;
    const std::int64_t end = std::min(run.step() + steps_between_checks, steps);
    run.go_on(end);
    const std::int64_t last = run.diverged_at(0).value_or(end + 1) - 1;
    if (next_sample > last) continue;
    if (next_sample == end) {
      show(end, run.synchronous());
    } else {
      auto again = run.begin_of_window();
      for (std::int64_t n = next_sample; n <= last; n += every) {
        stepper.advance(again, n - again.step);  // a watched loop beside it keeps g++ from inlining the force
        show(n, stepper.synchronous(again));
      }
    }
  }
  return {run.synchronous(), run.step(), run.diverged_at(0)};
}

/// Integrates without observer.
template <class Stepper>
outcome<Stepper::dimension> integrate(const Stepper& stepper,
                                      const phase_point<double, Stepper::dimension>& start,
                                      std::int64_t steps) {
  const auto no_observer = [](auto&&...) {};
  return integrate(stepper, start, steps, no_observer, std::max<std::int64_t>(steps, 1));
}

/// Integrates by a method at a step. For many trajectories make the stepper once.
template <System S, class Observer>
outcome<S::dimension> integrate(const S& system, const method& method, double step,
                                const phase_point<double, S::dimension>& start, std::int64_t steps,
                                Observer&& observer, std::int64_t every = 1) {
  return integrate(make_stepper(system, method, step), start, steps, std::forward<Observer>(observer), every);
}
/// Integrates by a method at a step, without observer.
template <System S>
outcome<S::dimension> integrate(const S& system, const method& method, double step,
                                const phase_point<double, S::dimension>& start, std::int64_t steps) {
  return integrate(make_stepper(system, method, step), start, steps);
}

}  // namespace nysalt
