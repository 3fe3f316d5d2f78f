// SPDX-License-Identifier: BSL-1.0
// The open run and the one loop through which every method steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "nysalt/prepared_word.hpp"

namespace nysalt {

/// A trajectory under way. `state` is ahead of the synchronous state by the word's first letter where
/// that letter merges with the last; the open run is all that is needed to go on, to the bit.
template <Scalar T, int N>
struct open_run {
  flow_state<T, N> state;
  std::int64_t step = 0;
};

/// A word with coefficients, a step and a system. The system is referred to, not copied.
/// C is double, or the scalar of the states that are stepped (learning).
template <System S, Word W, Scalar C = double>
class stepper {
 public:
  using system_type = S;
  static constexpr int dimension = S::dimension;

  using coefficients_type = typename W::template coefficients<C>;

  /// Throws std::invalid_argument if the step is zero or not finite, or if a run-time word has another number
  /// of letters than of coefficients. A negative step goes back in time.
  stepper(const S& system, const W& word, const coefficients_type& coefficients, double step)
      : system_(&system), step_(step), letters_(word, coefficients, step) {
    if (!std::isfinite(step) || step == 0.0) {
      throw std::invalid_argument(fmt::format("the step must be finite and not zero, got {}", step));
    }
  }
  stepper(const S& system, const coefficients_type& coefficients, double step) requires TypeLevelWord<W>
      : stepper(system, W{}, coefficients, step) {}
  stepper(const S&&, const W&, const coefficients_type&, double) = delete;  // it would refer to a temporary
  stepper(const S&&, const coefficients_type&, double) = delete;

  double step_size() const { return step_; }
  const S& system() const { return *system_; }

  /// Begins a run at x. Cost: the word's evaluations_to_open. Throws std::invalid_argument if x has not the
  /// system's dimension.
  template <SteppedBy<C> T>
  open_run<T, dimension> open(const phase_point<T, dimension>& x) const {
    require_size(x);
    open_run<T, dimension> run{{{x.q, x.p}, make_vector<T>(*system_)}};
    for (Eigen::Index i = 0; i < run.state.f.size(); ++i)
      run.state.f[i] = T(0.0);  // a checkpoint has no noise
    letters_.open(*system_, run.state);
    return run;
  }

  /// THE loop. Cost: steps times the word's evaluations_per_step; allocates nothing that the force does not.
  /// Throws std::invalid_argument if steps < 0. If the force throws, the run is lost: go on from a copy.
  template <Scalar T>
  void advance(open_run<T, dimension>& run, std::int64_t steps) const {
    if (steps < 0) throw std::invalid_argument(fmt::format("a run cannot advance by {} steps", steps));
    flow_state<T, dimension> x = std::move(run.state);  // local: it cannot alias the system
    decltype(auto) letters = letters_.in_loop();
    letters.advance(*system_, x, steps);
    run.state = std::move(x);
    run.step += steps;
  }

  /// The same, watched: calls look(n, x) with the synchronous state at each step n that `every` divides. The
  /// run stays in a local copy, and looking does not change it.
  template <Scalar T, class Look>
  void advance(open_run<T, dimension>& run, std::int64_t steps, std::int64_t every, Look&& look) const {
    if (steps < 0 || every < 1) {
      throw std::invalid_argument(
          fmt::format("a run cannot advance by {} steps, watched every {}", steps, every));
    }
    flow_state<T, dimension> x = std::move(run.state);
    flow_state<T, dimension> y = x;
    decltype(auto) letters = letters_.in_loop();
    const S& system = *system_;
    const std::int64_t end = run.step + steps;
    std::int64_t step = run.step;
    while (step < end) {
      const std::int64_t next = std::min(end, (step / every + 1) * every);
      letters.advance(system, x, next - step);
      step = next;
      if (step % every != 0) continue;
      y = x;
      letters_.close(system, y);
      look(step, static_cast<const phase_point<T, dimension>&>(y));
    }
    run.state = std::move(x);
    run.step = end;
  }

  /// The state at the run's step, as a copy: looking does not change the run, and costs no evaluation.
  template <Scalar T>
  phase_point<T, dimension> synchronous(const open_run<T, dimension>& run) const {
    flow_state<T, dimension> x = run.state;
    letters_.close(*system_, x);
    return {std::move(x.q), std::move(x.p)};
  }

  /// One plain step, letter by letter, from q and p alone (f is scratch): what learning and the
  /// analyses differentiate. Cost: the word's evaluations_of_plain_step.
  template <SteppedBy<C> T>
  void step(flow_state<T, dimension>& x) const {
    letters_.step(*system_, x);
  }
  template <SteppedBy<C> T>
  void step(phase_point<T, dimension>& x) const {
    require_size(x);
    flow_state<T, dimension> state{{std::move(x.q), std::move(x.p)}, make_vector<T>(*system_)};
    step(state);
    x = {std::move(state.q), std::move(state.p)};
  }

 private:
  template <Scalar T>
  void require_size(const phase_point<T, dimension>& x) const {
    if (x.q.size() == size(*system_) && x.p.size() == x.q.size()) return;
    throw std::invalid_argument(
        fmt::format("the state has {} positions and {} momenta, the system {} of each", x.q.size(),
                    x.p.size(), size(*system_)));
  }

  const S* system_;
  double step_;
  prepared_word<W, C> letters_;
};

}  // namespace nysalt
