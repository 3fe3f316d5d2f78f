// SPDX-License-Identifier: BSL-1.0
// One trajectory from start to finish, watched over.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "nysalt/detail/divergence.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// How a trajectory ended. Where it diverged, `finish` is the state at that step.
template <int N>
struct outcome {
  phase_point<double, N> finish;            ///< the last state
  std::int64_t steps = 0;                   ///< how many were taken
  std::optional<std::int64_t> diverged_at;  ///< the first bad step; nothing where all went well
};

/// Takes `steps` steps of a stepper from start, with the noise of that trajectory. The observer is called as
/// observer(n, t, state) with t = n h at n = 0, every, 2 every, ...; what it sees is synchronous, and looking
/// does not change the run.
///
/// Divergence is looked for every 64 steps and at the end, whoever observes what. Where it is found, that
/// stretch is gone through again to name the first bad step, and no observer sees that step or a later one.
/// A stretch with samples inside is gone through twice as well: they are shown when its end is known to be
/// good. Cost: that of the steps, up to twice where samples are less than 64 steps apart.
/// Near the edge of a stability window a bounded motion can swing beyond the criterion and back: that counts
/// if it is beyond when it is looked at.
/// Throws std::invalid_argument if steps < 0, every < 1 or the start is not finite or does not fit.
template <class Stepper, class Observer>
outcome<Stepper::dimension> integrate(const Stepper& stepper,
                                      const phase_point<double, Stepper::dimension>& start,
                                      std::int64_t steps, Observer&& observer, std::int64_t every,
                                      std::uint64_t trajectory = 0) {
  constexpr std::int64_t stretch = steps_between_checks;
  if (steps < 0 || every < 1) {
    throw std::invalid_argument(sentence("integrate: {} steps, observed every {}: cannot be", steps, every));
  }
  if (start.q.size() != size(stepper.system()) || start.p.size() != start.q.size() || !is_finite(start)) {
    throw std::invalid_argument("integrate: the start must be finite and have the system's dimension");
  }
  const divergence diverged(stepper.system(), start);
  const auto next_multiple = [](std::int64_t n, std::int64_t of) { return (n / of + 1) * of; };
  const auto show = [&](std::int64_t n, const auto& x) {
    if (n % every == 0) observer(n, static_cast<double>(n) * stepper.step_size(), x);
  };
  auto run = stepper.open(start, trajectory);
  auto good = run;
  show(0, start);
  while (run.step < steps) {
    good = run;
    const std::int64_t end = std::min(next_multiple(run.step, stretch), steps);
    stepper.advance(run, end - run.step);
    const auto x = stepper.synchronous(run);
    const bool failed = diverged(x);
    if (!failed && next_multiple(good.step, every) >= end) {
      show(end, x);
      continue;
    }
    while (good.step < end) {
      const std::int64_t next = failed ? good.step + 1 : std::min(next_multiple(good.step, every), end);
      stepper.advance(good, next - good.step);
      const auto y = stepper.synchronous(good);
      if (failed && diverged(y)) return {y, good.step, good.step};
      show(good.step, y);
    }
  }
  return {stepper.synchronous(run), run.step, std::nullopt};
}

/// The same unobserved: only the finish is wanted.
template <class Stepper>
outcome<Stepper::dimension> integrate(const Stepper& stepper,
                                      const phase_point<double, Stepper::dimension>& start,
                                      std::int64_t steps) {
  const auto nobody = [](auto&&...) {};
  return integrate(stepper, start, steps, nobody, std::max<std::int64_t>(steps, 1));
}

/// The same for a method at a step. For many trajectories make the stepper once.
template <System S, Method M, class Observer>
outcome<S::dimension> integrate(const S& system, const M& method, double step,
                                const phase_point<double, S::dimension>& start, std::int64_t steps,
                                Observer&& observer, std::int64_t every = 1) {
  return integrate(make_stepper(system, method, step), start, steps, std::forward<Observer>(observer), every);
}
/// The same for a method at a step, unobserved.
template <System S, Method M>
outcome<S::dimension> integrate(const S& system, const M& method, double step,
                                const phase_point<double, S::dimension>& start, std::int64_t steps) {
  return integrate(make_stepper(system, method, step), start, steps);
}

}  // namespace nysalt
