// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/ensembles/highest_frequency.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/baoab.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// How long the trajectory is, and what is kept of it.
struct long_trajectory_options {
  double length = 25'000.0;            ///< a time, burn-in included
  double burn_in = 0.0;                ///< a time at its beginning, of which no state is kept
  double step = 0.0;                   ///< h of BAOAB; 0: omega h = 0.1 at the highest frequency
  std::int64_t most_states = 100'000;  ///< that are kept, evenly thinned; at most 100000
  std::uint64_t seed = 1;              ///< of the start and the noise
};

namespace detail {
/// Throws std::invalid_argument if the options cannot be, with the step that was found.
void require_long_trajectory(const long_trajectory_options& options, double step);
}  // namespace detail

/// States picked at random, with repetition, from one trajectory of a system in its bath, by BAOAB from start
/// 0 of another ensemble [li_lu_tao_ye_2023]. They depend on each other as far as the trajectory remembers:
/// of friction gamma it holds no more than about gamma T/2 independent ones, and without a burn-in its way
/// down from the start stays among them; independent states of the invariant law are gibbs. On-step momenta
/// are those of BAOAB, whose variance is low by (omega h)^2/4. Memory: the states that are kept.
template <int N>
class one_long_trajectory {
 public:
  /// Throws std::invalid_argument if the options cannot be, or there is neither a step nor frequency_bands();
  /// std::runtime_error if the trajectory diverges.
  template <HasBath S, Ensemble<S> E>
    requires(S::dimension == N)
  one_long_trajectory(const S& system, const E& from, const long_trajectory_options& options = {})
      : options_(options), from_(from.description()) {
    step_ = options.step != 0.0 ? options.step : step_of_frequency(system, 0.1, "one_long_trajectory");
    detail::require_long_trajectory(options, step_);
    const auto steps = static_cast<std::int64_t>(options.length / step_);
    const auto first = static_cast<std::int64_t>(std::ceil(options.burn_in / step_));
    const std::int64_t every = (steps - first) / options.most_states + 1;
    std::vector<phase_point<double, N>> kept;
    const auto keep = [&](std::int64_t n, double, const phase_point<double, N>& x) {
      if (n >= first) kept.push_back(x);
    };
    using method_type = std::conditional_t<ErasedSystem<S>, tabulated, baoab>;
    const auto stepper = make_stepper(system, method_type(baoab{}), step_,
                                      counter_noise(options.seed, noise_purpose::burn_in));
    const auto end = integrate(stepper, sound_start(system, from, options.seed, 0), steps, keep, every);
    if (end.diverged_at) {
      throw std::runtime_error(
          sentence("one_long_trajectory: it diverged at time {}: the motion of {} is not confined, or the "
                   "step {} is too large",
                   in_digits(static_cast<double>(*end.diverged_at) * step_, 6), describe(system),
                   in_digits(step_, 6)));
    }
    if (kept.empty()) {
      throw std::invalid_argument(
          sentence("one_long_trajectory: after a burn-in of {} a length of {} leaves no state to keep: "
                   "take more states or less "
                   "burn-in",
                   options.burn_in, options.length));
    }
    states_ = std::make_shared<const std::vector<phase_point<double, N>>>(std::move(kept));
  }

  std::size_t states() const { return states_->size(); }  ///< how many are kept

  /// The start of trajectory n: one of the states.
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    vector<double, 1> normal;
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normal);
    const double uniform = 0.5 * std::erfc(-normal[0] * std::sqrt(0.5));
    const auto index = static_cast<std::size_t>(uniform * static_cast<double>(states()));
    return (*states_)[std::min(index, states() - 1)];
  }

  std::string description() const {
    return sentence("one_long_trajectory(length={}, burn_in={}, step={}, seed={}, from {})", options_.length,
                    options_.burn_in, in_digits(step_, 6), options_.seed, from_);
  }

 private:
  long_trajectory_options options_;
  std::string from_;
  double step_ = 0.0;
  std::shared_ptr<const std::vector<phase_point<double, N>>> states_;
};

/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&) -> one_long_trajectory<S::dimension>;
/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&, const long_trajectory_options&) -> one_long_trajectory<S::dimension>;

}  // namespace nysalt
