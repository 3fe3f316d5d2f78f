// SPDX-License-Identifier: BSL-1.0
// The open run and the one loop through which every method steps.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/stepping/prepared_word.hpp"
#include "nysalt/stepping/served_letters.hpp"

namespace nysalt {

/// A trajectory under way. `state` is ahead of the synchronous state by the word's first letter where that
/// letter merges with the last, or behind by half a letter O; of a processed word it is the state of the
/// kernel from step 1 on, and the start itself at step 0. The open run is all that is needed to go on, to the
/// bit.
template <Scalar T, int N>
struct open_run {
  flow_state<T, N> state;        ///< ahead or behind, as said above
  std::int64_t step = 0;         ///< number of steps done
  std::uint64_t trajectory = 0;  ///< trajectory number of the noise, of lane 0
};

/// A word with coefficients, a step, a system, and the noise of the system's bath, if any. The system is
/// referred to, not copied. C is double, or the scalar of the states that are stepped (learning).
///
/// The letters O act if the system is in a bath; in none, or in one that does not act, they are deleted from
/// the word, and a step has the bits of the word that is left.
template <System S, Scalar C = double, NoiseSource Noise = no_noise>
class stepper {
  static constexpr bool may_be_noisy = HasBath<S>;

 public:
  using system_type = S;                          ///< type of the system
  using noise_type = Noise;                       ///< type of the noise source
  static constexpr int dimension = S::dimension;  ///< degrees of freedom

  /// Prepares the letters for the step, once for all runs. Throws std::invalid_argument if the step is zero
  /// or not finite; if the word has another number of slots than of coefficients, or a letter that the
  /// system does not serve; if a bath acts and the word has no letter O; or if it is noisy and there is no
  /// noise. A negative step goes back in time.
  stepper(const S& system, const word& letters, const std::vector<C>& coefficients, double step,
          const Noise& noise = {})
      : system_(&system),
        step_(step),
        noise_(noise),
        acts_(acts_on(system)),
        stochastic_letters_(letters.stochastic_letters),
        is_processed_(letters.is_processed()),
        takes_room_(letters.force_derivatives + letters.displaced_forces > 0 || letters.reads_modes),
        letters_(letters_of(system, letters, coefficients, step)) {
    if (!std::isfinite(step) || step == 0.0) {
      throw std::invalid_argument(sentence("the step must be finite and not zero, got {}", step));
    }
    if (acts_) require_thermostat(letters.view());
  }
  stepper(const S&&, const word&, const std::vector<C>&, double, const Noise& = {}) = delete;  // a temporary

  double step_size() const { return step_; }     ///< h; back in time it is negative
  const S& system() const { return *system_; }   ///< reference to the stepped system
  const Noise& noise() const { return noise_; }  ///< a copy of its source

  /// Begins a run at x, with the noise of that trajectory and of those after it in further lanes. Cost: the
  /// word's evaluations_to_open, which a processed word pays with its first step. Throws
  /// std::invalid_argument if x has not the system's dimension.
  template <SteppedBy<C> T>
  open_run<T, dimension> open(const phase_point<T, dimension>& x, std::uint64_t trajectory = 0) const {
    require_size(x);
    open_run<T, dimension> run{{{x.q, x.p}, detail::make_vector<T>(*system_)}, 0, trajectory};
    for (Eigen::Index i = 0; i < run.state.f.size(); ++i)
      run.state.f[i] = T(0.0);      // a checkpoint has no noise
    if (is_processed_) return run;  // which advance() opens
    auto cursor = cursor_at<T>(trajectory, 0);
    letters_.open(*system_, run.state, cursor);
    return run;
  }

  /// Takes `steps` steps: THE loop. Cost: steps times the word's evaluations_per_step, and a normal number
  /// for each momentum and letter O. Allocates nothing that the force does not; of a dynamic size, one vector
  /// with noise and a few for the letters D, G, R, H. Throws std::invalid_argument if steps < 0. If the force
  /// throws, the run is lost: go on from a copy.
  template <Scalar T>
  void advance(open_run<T, dimension>& run, std::int64_t steps) const {
    if (steps < 0) throw std::invalid_argument(sentence("stepper: steps must be >= 0, got {}", steps));
    flow_state<T, dimension> x = std::move(run.state);  // local: it cannot alias the system
    auto cursor = cursor_at<T>(run.trajectory, run.step);
    if (opens_now(run, steps)) letters_.open(*system_, x, cursor);
    letters_.advance(*system_, x, steps, cursor);
    run.state = std::move(x);
    run.step += steps;
  }

  /// Advances with an observer: calls observe(n, x) with the synchronous state at each step n that `every`
  /// divides. The run stays in a local copy, and looking does not change it. Cost: the word's
  /// evaluations_to_observe each time.
  template <Scalar T, class Observe>
  void advance(open_run<T, dimension>& run, std::int64_t steps, std::int64_t every, Observe&& observe) const {
    if (steps < 0 || every < 1) {
      throw std::invalid_argument(
          sentence("stepper: steps must be >= 0 and every >= 1, got {} and {}", steps, every));
    }
    flow_state<T, dimension> x = std::move(run.state);
    auto cursor = cursor_at<T>(run.trajectory, run.step);
    if (opens_now(run, steps)) letters_.open(*system_, x, cursor);
    letters_.advance(*system_, x, run.step, steps, every, cursor,
                     [&](std::int64_t n, const phase_point<T, dimension>& y) { observe(n, y); });
    run.state = std::move(x);
    run.step += steps;
  }

  /// The state at the run's step, as a copy: looking does not change the run. Cost: the word's
  /// evaluations_to_observe, which only a processed word has.
  template <Scalar T>
  phase_point<T, dimension> synchronous(const open_run<T, dimension>& run) const {
    if (is_processed_ && run.step == 0) return {run.state.q, run.state.p};
    flow_state<T, dimension> x = run.state;
    auto cursor = cursor_at<T>(run.trajectory, run.step);
    letters_.close(*system_, x, cursor);
    return {std::move(x.q), std::move(x.p)};
  }

  /// State of the kernel of a processed word, without P(-h), else the synchronous state, in x. No
  /// evaluation, and no allocation where x has the system's dimension.
  template <Scalar T>
  void of_kernel(const open_run<T, dimension>& run, flow_state<T, dimension>& x) const {
    x = run.state;
    if (is_processed_ && run.step == 0) return;
    auto cursor = cursor_at<T>(run.trajectory, run.step);
    if (is_processed_) return letters_.close_kernel(*system_, x, cursor);
    letters_.close(*system_, x, cursor);
  }

  /// One plain step, letter by letter, from only q and p (f is scratch): what learning and the
  /// analyses differentiate; of a processed word P(-h) K P(h)^-1, which is not what n steps of a run repeat.
  /// Its noise is the trajectory's noise of step n. Cost: the word's evaluations_of_plain_step.
  template <SteppedBy<C> T>
  void step(flow_state<T, dimension>& x, std::uint64_t trajectory = 0, std::int64_t n = 0) const {
    auto cursor = cursor_at<T>(trajectory, n);
    letters_.step(*system_, x, cursor);
  }
  template <SteppedBy<C> T>
  void step(phase_point<T, dimension>& x, std::uint64_t trajectory = 0, std::int64_t n = 0) const {
    require_size(x);
    flow_state<T, dimension> state{{std::move(x.q), std::move(x.p)}, detail::make_vector<T>(*system_)};
    step(state, trajectory, n);
    x = {std::move(state.q), std::move(state.p)};
  }

  /// A stepper of another copy of the system, which must outlive the stepper.
  stepper with_system(const S& copy) const {
    stepper result = *this;
    result.system_ = &copy;
    return result;
  }

  /// A run from x (whose f is scratch) that calls observe(k) after each number after[k] of steps, which rise,
  /// with the synchronous state in y: what losses over several steps differentiate. Its noise is the noise of
  /// steps 0, 1, ... of the trajectory. Cost: the word's evaluations_to_open, as many times its
  /// evaluations_per_step as there are steps, and its evaluations_to_observe each time.
  template <SteppedBy<C> T, class Observe>
  void run(flow_state<T, dimension>& x, flow_state<T, dimension>& y, std::span<const int> after,
           std::uint64_t trajectory, Observe&& observe) const {
    auto cursor = cursor_at<T>(trajectory, 0);
    letters_.open(*system_, x, cursor);
    int done = 0;
    for (std::size_t k = 0; k < after.size(); ++k) {
      letters_.advance(*system_, x, after[k] - done, cursor);
      done = after[k];
      y = x;
      letters_.close(*system_, y, cursor);
      observe(k);
    }
  }

 private:
  using letters_type = detail::prepared_word<C, dimension>;

  /// Whether the run of a processed word is at its start, and leaves it.
  bool opens_now(const auto& run, std::int64_t steps) const {
    return is_processed_ && run.step == 0 && steps > 0;
  }
  static bool acts_on(const S& system) {
    if constexpr (HasBath<S>) return static_cast<const bath&>(system.bath()).acts();
    return false;
  }
  static letters_type letters_of(const S& system, const word& letters, const std::vector<C>& c, double step) {
    const detail::surroundings_of_word around = surroundings(system, letters);
    if (acts_on(system)) return letters_type(system, letters, c, step, around);
    return letters_type(system, conservative_part(letters), conservative_part(letters, c), step, around);
  }

  /// Throws std::invalid_argument if the system does not serve a letter.
  static detail::surroundings_of_word surroundings(const S& system, const word& letters) {
    detail::surroundings_of_word result;
    if constexpr (HasBath<S>) result.heat_bath = static_cast<const bath&>(system.bath());
    require_served<S, C>(letters, system);
    if constexpr (HasQuadraticPart<S>) {
      if (letters.reads_modes) result.part = detail::modal_coordinates::of(system);
    }
    return result;
  }

  template <Scalar T>
  auto cursor_at(std::uint64_t trajectory, std::int64_t step) const {
    using room = detail::flow_room<T, dimension>;
    if constexpr (may_be_noisy) {
      const bath& heat_bath = system_->bath();
      const Eigen::Index numbers = acts_ || dimension != Eigen::Dynamic ? size(*system_) : 0;
      return detail::noise_cursor<Noise, T, dimension, room>{
          &noise_,
          trajectory,
          step,
          stochastic_letters_,
          heat_bath.sigma() > 0.0,
          vector<T, dimension>(numbers),
          room(takes_room_ || dimension != Eigen::Dynamic ? size(*system_) : 0)};
    } else {
      return detail::quiet_cursor<room>{
          room(takes_room_ || dimension != Eigen::Dynamic ? size(*system_) : 0)};
    }
  }
  void require_thermostat(std::string_view letters) const {
    if constexpr (HasBath<S>) {
      if (stochastic_letters_ == 0) {
        throw std::invalid_argument(
            sentence("the word for a system in a {} must have a letter O, got {}; thermostat the word, or "
                     "step the system without bath",
                     system_->bath().description(), letters));
      }
      if (std::is_same_v<Noise, no_noise> && system_->bath().sigma() > 0.0) {
        throw std::invalid_argument(
            sentence("the stepper must have a source of noise for the {}, got none; give one, such as "
                     "counter_noise(seed)",
                     system_->bath().description()));
      }
    }
  }

  template <Scalar T>
  void require_size(const phase_point<T, dimension>& x) const {
    if (x.q.size() == size(*system_) && x.p.size() == x.q.size()) return;
    throw std::invalid_argument(
        sentence("stepper: the state must fit the system, got {} positions and {} momenta for {} "
                 "degrees of freedom",
                 x.q.size(), x.p.size(), size(*system_)));
  }

  const S* system_;
  double step_;
  Noise noise_;
  bool acts_;  // the bath
  int stochastic_letters_;
  bool is_processed_;
  bool takes_room_;
  letters_type letters_;  // without letters O in a bath that does not act
};

}  // namespace nysalt
