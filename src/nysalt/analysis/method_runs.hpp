// SPDX-License-Identifier: BSL-1.0
// Methods beside the reference, along trajectories side by side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/detail/lockstep.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/along_path.hpp"
#include "reference_tracker.hpp"

namespace nysalt {

/// The noise that methods share with a reference: in how many parts of a step, and of which reference.
struct shared_noise {
  int parts = 0;           ///< 0: there is none
  std::uint64_t seed = 0;  ///< of the noise
  std::int64_t first = 0;  ///< number of the trajectory in lane 0
};

/// Methods beside the reference, from the same starts and with its noise; one trajectory in each lane. All
/// measures read the same runs.
template <class T>
class method_runs {
 public:
  using state = phase_point<T, Eigen::Dynamic>;        ///< states of all lanes
  using path_type = recorded_path<T, Eigen::Dynamic>;  ///< the reference's noise

  /// Refers to all but the start, and partly to itself.
  method_runs(const model& system, const detail::reference_value& reference,
              std::span<const tabulated> methods, double step, std::span<const error_measure> measures,
              const state& start, int count, const reference_checks& checks, const shared_noise& noise,
              const sample_weights& weights)
      : measures_(measures),
        step_(step),
        weights_(weights),
        path_(path_in(system, step, noise)),
        reference_(system, reference, measures, step, start, count, checks,
                   {noise.seed, static_cast<std::uint64_t>(noise.first), 0}, path_, noise.parts, weights) {
    for (const tabulated& method : methods) {
      const noise_type along(path_, intervals(method, noise), step);
      steppers_.push_back(make_stepper(system, method, step, along));
    }
    std::vector<error_sum<T>> none;
    for (const error_measure& measure : measures) none.emplace_back(measure, weights(0));
    for (const auto& stepper : steppers_) runs_.push_back({{stepper, start, count, noise.first}, none});
  }

  method_runs(const method_runs&) = delete;
  method_runs& operator=(const method_runs&) = delete;

  /// Follows the reference and all methods, one interval after the other, so that no path is kept.
  void run(std::int64_t steps) {
    const auto read = [&](const state& x, std::span<T> numbers) { measures_.read(x, numbers); };
    for (std::int64_t done = 0; done < steps; done += steps_between_checks) {
      const std::int64_t next = std::min(done + steps_between_checks, steps);
      reference_.go_on(done, next);
      for (watched_run& method_run : runs_) {
        method_run.run.go_on(next, 1, measures_.width(), read,
                             [&](std::int64_t n, std::span<const T> seen, const auto& live) {
                               for (std::size_t i = 0; i < measures_.size(); ++i) {
                                 method_run.errors[i].add(n, measures_.part(i, seen),
                                                          reference_.expected(i, n), live, weights_(n));
                               }
                             });
      }
    }
  }

  const reference_tracker<T>& reference() const { return reference_; }  ///< with its checks, after run()
  /// The score of a method by a measure, in lane k; after run().
  run_score score(std::size_t measure, std::size_t method, int k) const {
    return runs_[method].errors[measure].score(k, runs_[method].run.diverged_at(k));
  }

 private:
  using noise_type = along_path<T, Eigen::Dynamic>;
  using stepper_type = stepper<model, run_time_word, double, noise_type>;
  struct watched_run {
    lockstep<stepper_type, T> run;
    std::vector<error_sum<T>> errors;  // one a measure
  };

  /// Held in parts of a step.
  static path_type path_in(const model& system, double step, const shared_noise& noise) {
    return {std::abs(step) / std::max(noise.parts, 1), system.bath().friction(),
            static_cast<std::uint64_t>(noise.first)};
  }
  static noise_intervals intervals(const tabulated& method, const shared_noise& noise) {
    if (noise.parts == 0) return {};
    return intervals_of_noise(method.letters(), method.coefficients());
  }

  joined_measures measures_;
  double step_;
  sample_weights weights_;
  path_type path_;  // of the present interval
  reference_tracker<T> reference_;
  std::vector<stepper_type> steppers_;
  std::vector<watched_run> runs_;
};

}  // namespace nysalt
