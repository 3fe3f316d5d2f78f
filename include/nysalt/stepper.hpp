// SPDX-License-Identifier: BSL-1.0
// The open run and the one loop through which every method steps.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "nysalt/force.hpp"
#include "nysalt/word.hpp"

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
  static constexpr int dimension = S::dimension;

  /// Throws std::invalid_argument if the step is zero or not finite. A negative step goes back in time.
  stepper(const S& system, const std::array<C, W::length>& coefficients, double step)
      : system_(&system), step_(step), letters_(prepare(coefficients, step, all_letters{})) {
    if (!std::isfinite(step) || step == 0.0) {
      throw std::invalid_argument(fmt::format("the step must be finite and not zero, got {}", step));
    }
    using first = typename W::template letter<0>;
    if constexpr (W::merges) {
      seam_ = first::prepare(coefficients[W::length - 1] + coefficients[0], step);
      undo_ = first::prepare(-coefficients[0], step);
    }
  }
  stepper(const S&&, const std::array<C, W::length>&, double) = delete;  // it would refer to a temporary

  double step_size() const { return step_; }
  const S& system() const { return *system_; }

  /// Begins a run at x. Cost: W::evaluations_to_open. Throws std::invalid_argument if x has not the
  /// system's dimension.
  template <SteppedBy<C> T>
  open_run<T, dimension> open(const phase_point<T, dimension>& x) const {
    require_size(x);
    open_run<T, dimension> run{{x.q, x.p, make_vector<T>(*system_)}};
    for (Eigen::Index i = 0; i < run.state.f.size(); ++i)
      run.state.f[i] = T(0.0);  // a checkpoint has no noise
    if constexpr (W::evaluations_to_open > 0) force<T>(*system_, run.state.q, run.state.f);
    if constexpr (W::merges) {
      W::template letter<0>::apply(*system_, std::get<0>(letters_), run.state);
    }
    return run;
  }

  /// THE loop. Cost: steps * W::evaluations_per_step; allocates nothing that the force does not. Throws
  /// std::invalid_argument if steps < 0. If the force throws, the run is lost: go on from a copy.
  template <Scalar T>
  void advance(open_run<T, dimension>& run, std::int64_t steps) const {
    if (steps < 0) throw std::invalid_argument(fmt::format("a run cannot advance by {} steps", steps));
    // A local state and local coefficients cannot alias the system, so they stay in registers.
    flow_state<T, dimension> x = std::move(run.state);
    const auto letters = letters_;
    const auto seam = seam_;
    const S& system = *system_;
    for (std::int64_t n = 0; n < steps; ++n) {
      loop_letters<W::first_in_loop>(system, letters, seam, x);
    }
    run.state = std::move(x);
    run.step += steps;
  }

  /// The state at the run's step, as a copy: looking does not change the run, and costs no evaluation.
  template <Scalar T>
  phase_point<T, dimension> synchronous(const open_run<T, dimension>& run) const {
    if constexpr (W::merges) {
      flow_state<T, dimension> x = run.state;
      W::template letter<0>::apply(*system_, undo_, x);
      return {std::move(x.q), std::move(x.p)};
    } else {
      return {run.state.q, run.state.p};
    }
  }

  /// One plain step, letter by letter, from q and p alone (f is scratch): what learning and the
  /// analyses differentiate. Cost: W::evaluations_of_plain_step.
  template <SteppedBy<C> T>
  void step(flow_state<T, dimension>& x) const {
    plain_letters<0>(*system_, x);
  }
  template <Scalar T>
  void step(phase_point<T, dimension>& x) const {
    require_size(x);
    flow_state<T, dimension> state{std::move(x.q), std::move(x.p), make_vector<T>(*system_)};
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

  using all_letters = std::make_index_sequence<W::length>;

  template <std::size_t... I>
  static auto prepare(const std::array<C, W::length>& c, double h, std::index_sequence<I...>) {
    return std::tuple(W::template letter<I>::prepare(c[I], h)...);
  }

  template <std::size_t I, class T>
  [[gnu::always_inline]] static void loop_letters(const S& system, const auto& letters, const auto& seam,
                                                  flow_state<T, dimension>& x) {
    using L = typename W::template letter<I>;
    if constexpr (L::reads_force && !W::known_in_loop[I]) force<T>(system, x.q, x.f);
    if constexpr (W::merges && I + 1 == W::length) {
      L::apply(system, seam, x);
    } else {
      L::apply(system, std::get<I>(letters), x);
    }
    if constexpr (I + 1 < W::length) loop_letters<I + 1>(system, letters, seam, x);
  }

  template <std::size_t I, class T>
  [[gnu::always_inline]] void plain_letters(const S& system, flow_state<T, dimension>& x) const {
    using L = typename W::template letter<I>;
    if constexpr (L::reads_force && !W::known_in_step[I]) force<T>(system, x.q, x.f);
    L::apply(system, std::get<I>(letters_), x);
    if constexpr (I + 1 < W::length) plain_letters<I + 1>(system, x);
  }

  using letters_type = decltype(prepare(std::declval<std::array<C, W::length>>(), 1.0, all_letters{}));

  const S* system_;
  double step_;
  letters_type letters_;
  std::tuple_element_t<0, letters_type> seam_{};  // last and first letter in one
  std::tuple_element_t<0, letters_type> undo_{};  // the first letter taken back
};

}  // namespace nysalt
