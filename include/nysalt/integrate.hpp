// SPDX-License-Identifier: BSL-1.0
// One trajectory from start to finish, watched over.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "nysalt/energy.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// How a trajectory ended. Where it diverged, `finish` is the state at that step.
template <int N>
struct outcome {
  phase_point<double, N> finish;
  std::int64_t steps = 0;
  std::optional<std::int64_t> diverged_at;
};

/// Tells runaway states: not finite, or |H - H_0| > 1e3 max(|H_0|, 1). Without an energy only the first.
template <System S>
class divergence {
 public:
  divergence(const S& system, const phase_point<double, S::dimension>& start) : system_(&system) {
    if constexpr (HasEnergy<S>) initial_ = energy<double>(system, start);
  }

  bool operator()(const phase_point<double, S::dimension>& x) const {
    if (!is_finite(x)) return true;
    if constexpr (HasEnergy<S>) {
      const double change = std::abs(energy<double>(*system_, x) - initial_);
      return !(change <= 1e3 * std::max(std::abs(initial_), 1.0));
    }
    return false;
  }

 private:
  const S* system_;
  double initial_ = 0.0;
};

/// Takes `steps` steps of a stepper from start. The observer is called as observer(n, t, state) with
/// t = n h at n = 0, every, 2 every, ...; what it sees is synchronous, and looking does not change the run.
///
/// Divergence is looked for at every observed step and at least every 64 steps; the run is then repeated
/// from the last good state to name the first bad step. No observer sees a diverged state.
/// Throws std::invalid_argument if steps < 0, every < 1 or the start is not finite or does not fit.
template <class Stepper, class Observer>
outcome<Stepper::dimension> integrate(const Stepper& stepper,
                                      const phase_point<double, Stepper::dimension>& start,
                                      std::int64_t steps, Observer&& observer, std::int64_t every) {
  constexpr std::int64_t check_every = 64;  // energy costs about a force: 2 % of a one-stage method
  if (steps < 0 || every < 1) {
    throw std::invalid_argument(
        fmt::format("integrate: {} steps, observed every {}: cannot be", steps, every));
  }
  if (start.q.size() != size(stepper.system()) || start.p.size() != start.q.size() || !is_finite(start)) {
    throw std::invalid_argument("integrate: the start must be finite and have the system's dimension");
  }
  const divergence diverged(stepper.system(), start);
  auto run = stepper.open(start);
  observer(std::int64_t{0}, 0.0, start);
  while (run.step < steps) {
    const auto good = run;
    const std::int64_t to_sample = every - run.step % every;
    stepper.advance(run, std::min({check_every, to_sample, steps - run.step}));
    auto x = stepper.synchronous(run);
    if (diverged(x)) {
      run = good;
      do {
        stepper.advance(run, 1);
        x = stepper.synchronous(run);
      } while (!diverged(x));
      return {std::move(x), run.step, run.step};
    }
    if (run.step % every == 0) observer(run.step, static_cast<double>(run.step) * stepper.step_size(), x);
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
template <System S, Method M>
outcome<S::dimension> integrate(const S& system, const M& method, double step,
                                const phase_point<double, S::dimension>& start, std::int64_t steps) {
  return integrate(make_stepper(system, method, step), start, steps);
}

}  // namespace nysalt
