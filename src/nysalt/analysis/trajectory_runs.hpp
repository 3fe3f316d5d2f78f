// SPDX-License-Identifier: BSL-1.0
// Runs of methods and of their reference side by side, and the measures that see them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/shard.hpp"

namespace nysalt {

/// Several measures that read the same states: the numbers of all lie one after the other.
class joined_measures {
 public:
  /// All of them, or only those that need a reference: of the others then nothing is read.
  enum class which { all, of_reference };

  /// Refers to the measures.
  explicit joined_measures(std::span<const error_measure> measures, which wanted = which::all)
      : measures_(measures) {
    for (const error_measure& measure : measures) {
      const bool counts = wanted == which::all || measure.needs_reference;
      begins_.push_back(begins_.back() + (counts ? measure.width : 0));
    }
  }

  std::size_t size() const { return measures_.size(); }                          ///< number of measures
  const error_measure& operator[](std::size_t i) const { return measures_[i]; }  ///< measure i
  /// Number of values that are read of a state.
  std::size_t width() const { return begins_.back(); }
  /// Whether anything is read for measure i.
  bool reads(std::size_t i) const { return begins_[i + 1] > begins_[i]; }

  /// Writes all width() numbers of a state.
  template <class T>
  void read(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) const {
    for (std::size_t i = 0; i < size(); ++i) {
      if (reads(i)) measures_[i].read(x, result.subspan(begins_[i], begins_[i + 1] - begins_[i]));
    }
  }
  /// The numbers of measure i among all of a state.
  template <class T>
  std::span<const T> part(std::size_t i, std::span<const T> all) const {
    return all.subspan(begins_[i], begins_[i + 1] - begins_[i]);
  }

 private:
  std::span<const error_measure> measures_;
  std::vector<std::size_t> begins_{0};  // and where the last ends
};

}  // namespace nysalt

// Scores of all trajectories by one measure, gathered over the ranks.

namespace nysalt::detail {

/// Scores of all trajectories by one measure.
struct measured_trajectories {
  /// Nothing yet.
  measured_trajectories(std::size_t methods, std::size_t trajectories, std::size_t checked, bool null,
                        std::size_t perturbed);

  /// Each rank has filled in its own, and all get all. The few that checks are of are in the first leaf.
  void gather(const shard& own);
  /// Summary over all trajectories. Throws std::invalid_argument where what errors are relative to is 0, or a
  /// scale is of both signs.
  trajectory_errors_result summary(const error_measure& measure, const std::string& reference) const;

  std::vector<std::vector<run_score>> runs;  // of each method
  std::vector<double> checks;                // of the reference against its finer self
  std::vector<double> null_model;
  std::vector<double> predictable_until;
  std::vector<double> sizes;  // means over time of what errors are relative to
  std::vector<double> signs;  // of scales; 0 where there is none
};

}  // namespace nysalt::detail

// Readings of measures along a reference.

namespace nysalt {

/// Readings of measures along a reference, an interval of samples at a time; one trajectory in each lane. In
/// a bath the noise of that interval is kept for the methods that follow.
template <class T>
class reference_along {
 public:
  using state = phase_point<T, Eigen::Dynamic>;        ///< states of all lanes
  using path_type = recorded_path<T, Eigen::Dynamic>;  ///< noise, in parts of a step

  /// Refers to measures and path, to which the kept noise of each interval is added.
  reference_along(const model& system, const nysalt::reference& reference, const joined_measures& measures,
                  const state& start, const reference_intervals& intervals, path_type* path = nullptr)
      : description_(reference.description()),
        measures_(&measures),
        run_(reference.open(system, start, intervals)),
        count_(intervals.count),
        step_(intervals.at.step),
        path_(path),
        signs_(measures.size()) {}

  /// Reads the next `samples`, each an interval after the last. What is not sound is remembered.
  void go_on(std::int64_t samples) {
    const std::size_t width = measures_->width();
    numbers_.resize(static_cast<std::size_t>(samples) * width);
    // A letter O that ends the step before the interval is still to come.
    if (path_ != nullptr) path_->forget_before((step_ - 1) * std::ssize(run_->noise()));
    for (std::int64_t i = 0; i < samples; ++i) {
      run_->advance();
      for (const auto& xi : run_->noise()) path_->add(xi);
      ++step_;
      const auto here = std::span(numbers_).subspan(static_cast<std::size_t>(i) * width, width);
      measures_->read(run_->state(), here);
      inspect(here);
    }
  }

  /// The numbers of sample i of the last interval.
  std::span<const T> at(std::int64_t i) const {
    const std::size_t width = measures_->width();
    return std::span(numbers_).subspan(static_cast<std::size_t>(i) * width, width);
  }

  /// The sign of the scale of a measure in lane k; 0 where it has none.
  double sign(std::size_t measure, int k) const { return signs_[measure][static_cast<std::size_t>(k)]; }

  /// Throws for the first trajectory that came to grief: std::runtime_error where the reference, or what is
  /// read of it, is not finite; std::invalid_argument where a measure has no scale, or one that changes sign.
  /// `first` is in lane 0.
  void require_sound(std::int64_t first) const {
    for (int k = 0; k < count_; ++k) {
      const auto& first_failure = failures_[static_cast<std::size_t>(k)];
      if (!first_failure) continue;
      const auto& measure = (*measures_)[first_failure->measure];
      if (first_failure->without_scale) throw std::invalid_argument(measure.no_scale);
      throw std::runtime_error(
          sentence("trajectory {} of the reference ({}), and what the {} error reads of it, must be finite, "
                   "got another number at step {}; take other starts, a finer reference or a shorter horizon",
                   first + k, description_, measure.name, first_failure->step));
    }
  }

 private:
  struct failure {
    std::int64_t step;
    std::size_t measure;
    bool without_scale;
  };

  void inspect(std::span<const T> all) {
    const auto finite = is_finite(run_->state());
    for (std::size_t i = 0; i < measures_->size(); ++i) {
      const auto here = measures_->part(i, all);
      auto sound = finite;
      for (const T& number : here) {
        sound = both(sound, number - number == T(0.0));  // NOLINT(misc-redundant-expression): NaN, infinity
      }
      std::optional<T> scale;
      if (measures_->reads(i) && (*measures_)[i].scale) scale = (*measures_)[i].scale(here);
      for (int k = 0; k < count_; ++k) {
        auto& first_failure = failures_[static_cast<std::size_t>(k)];
        const bool without_scale = scale && !keeps_sign(i, k, lane(*scale, k));
        if (first_failure || (lane(sound, k) && !without_scale)) continue;
        first_failure = failure{step_, i, lane(sound, k)};
      }
    }
  }

  /// Whether the scale has the sign that it had before; not where the scale is 0.
  bool keeps_sign(std::size_t measure, int k, double scale) {
    double& known_sign = signs_[measure][static_cast<std::size_t>(k)];
    if (known_sign == 0.0) known_sign = scale > 0.0 ? 1.0 : scale < 0.0 ? -1.0 : 0.0;
    return known_sign * scale > 0.0 || std::isnan(scale);
  }

  std::string description_;  // of the reference
  const joined_measures* measures_;
  std::unique_ptr<reference_run<T>> run_;
  int count_;
  std::int64_t step_;
  path_type* path_;
  std::vector<T> numbers_;
  std::array<std::optional<failure>, static_cast<std::size_t>(lanes_in<T>)> failures_{};
  std::vector<std::array<double, static_cast<std::size_t>(lanes_in<T>)>>
      signs_;  // of the scale of each measure
};

// The reference that methods are compared with, and what it is compared with itself.

/// On how many of the trajectories, from the first on, a reference is compared with itself.
struct reference_checks {
  int finer = 0;                            ///< with its finer self
  int perturbed = 0;                        ///< with itself from perturbed starts
  std::optional<double> perturbation = {};  ///< relative size, of every coordinate
  bool null_model = false;                  ///< whether that is compared too, on all trajectories
};

/// Expected values of measures along trajectories in lanes: the numbers of the reference, or those at the
/// start. Beside them go the reference's finer self, one from perturbed starts on the same noise, and the
/// null model in which all stays as it was at the start; each only as far as it is wanted.
template <class T>
class reference_tracker {
 public:
  using state = phase_point<T, Eigen::Dynamic>;        ///< states of all lanes
  using path_type = recorded_path<T, Eigen::Dynamic>;  ///< the reference's noise

  /// Refers to all but the start, and to itself. The noise is added to the path in `parts` parts of a step.
  reference_tracker(const model& system, const nysalt::reference& reference,
                    std::span<const error_measure> measures, double step, const state& start, int count,
                    const reference_checks& checks, const path_place& at, path_type& path, int noise_parts,
                    const sample_weights& weights)
      : measures_(measures, joined_measures::which::of_reference),
        step_(step),
        weights_(weights),
        checks_(checks),
        live_(first_lanes<T>(count)) {
    for (const error_measure& measure : measures) {
      at_start_.push_back(measure.numbers_of(start));
      if (!measure.needs_reference && measure.scale) require_scale(measure, at_start_.back(), count);
      const error_sum<T> none(measure, weights(0));
      errors_.push_back({none, none, none, predictable_samples<T>(measure.how)});
      if (measure.relative_to) {  // of what needs no reference that is all
        const double weight = measure.needs_reference ? weights(0) : weights.total();
        errors_.back().size = measure.relative_to(at_start_.back()) * weight;
      }
    }
    const bool needed = measures_.width() > 0;
    if (needed || noise_parts > 0) {
      reference_.emplace(system, reference, measures_, start,
                         reference_intervals{step, count, at, noise_parts}, &path);
    }
    if (needed && checks.finer > 0) {
      finer_.emplace(system, reference.finer(), measures_, start,
                     reference_intervals{step, checks.finer, at});
    }
    if (needed && checks.perturbed > 0 && checks.perturbation) {
      const auto from = nysalt::perturbed(start, *checks.perturbation, at.seed, at.trajectory);
      perturbed_.emplace(system, reference, measures_, from, reference_intervals{step, checks.perturbed, at});
    }
  }

  reference_tracker(const reference_tracker&) = delete;
  reference_tracker& operator=(const reference_tracker&) = delete;

  /// Goes on through the samples from + 1 .. to.
  void go_on(std::int64_t from, std::int64_t to) {
    from_ = from;
    if (reference_) reference_->go_on(to - from);
    if (finer_) finer_->go_on(to - from);
    if (perturbed_) perturbed_->go_on(to - from);
    for (std::size_t i = 0; i < measures_.size(); ++i) {
      if (measures_.reads(i)) compare(i, to);
    }
  }

  /// The expected values of measure i at sample n of the last interval.
  std::span<const T> expected(std::size_t i, std::int64_t n) const {
    return measures_.reads(i) ? seen_by(*reference_, i, n) : std::span<const T>(at_start_[i]);
  }

  /// See reference_along; `first` is the number of the trajectory in lane 0.
  void require_sound(std::int64_t first) const {
    if (reference_) reference_->require_sound(first);
    if (finer_) finer_->require_sound(first);
  }
  /// The reference's own error, against its finer self, by measure i in lane k, if it was wanted.
  double finer_error(std::size_t i, int k) const { return errors_[i].finer.score(k).value; }
  /// The null model's error by measure i in lane k, if it was wanted.
  double null_error(std::size_t i, int k) const { return errors_[i].null_model.score(k).value; }
  /// The mean over time of what measure i is relative to, in lane k.
  double size(std::size_t i, int k) const { return lane(errors_[i].size, k) / weights_.total(); }
  /// The sign of the scale of measure i in lane k; 0 if it has none.
  double sign(std::size_t i, int k) const {
    if (!measures_[i].scale) return 0.0;
    if (measures_.reads(i)) return reference_->sign(i, k);
    return std::copysign(1.0, lane(measures_[i].scale(at_start_[i]), k));
  }
  /// A time, by measure i in lane k, if it was wanted; infinite if it is beyond the end.
  double predictable_until(std::size_t i, int k) const {
    return errors_[i].predictable.until(k) * std::abs(step_);
  }

 private:
  struct errors_of_measure {
    error_sum<T> finer;
    error_sum<T> null_model;
    error_sum<T> perturbed;
    predictable_samples<T> predictable;
    T size{0.0};  // what the errors are relative to, summed over time
  };

  std::span<const T> seen_by(const reference_along<T>& run, std::size_t i, std::int64_t n) const {
    return measures_.part(i, run.at(n - from_ - 1));
  }

  void compare(std::size_t i, std::int64_t to) {
    errors_of_measure& errors = errors_[i];
    for (std::int64_t n = from_ + 1; n <= to; ++n) {
      const auto exact = expected(i, n);
      const double weight = weights_(n);
      if (measures_[i].relative_to) errors.size += measures_[i].relative_to(exact) * weight;
      if (finer_) errors.finer.add(n, exact, seen_by(*finer_, i, n), live_, weight);
      if (checks_.null_model || perturbed_) errors.null_model.add(n, at_start_[i], exact, live_, weight);
      if (!perturbed_) continue;
      errors.perturbed.add(n, seen_by(*perturbed_, i, n), exact, live_, weight);
      errors.predictable.add(n, errors.perturbed.sum(), errors.null_model.sum());
    }
  }

  static void require_scale(const error_measure& measure, std::span<const T> at_start, int count) {
    const T scale = measure.scale(at_start);
    for (int k = 0; k < count; ++k) {
      if (lane(scale, k) == 0.0) throw std::invalid_argument(measure.no_scale);
    }
  }

  joined_measures measures_;  // those that need a reference
  double step_;
  sample_weights weights_;
  reference_checks checks_;
  condition_of<T> live_;
  std::int64_t from_ = 0;
  std::vector<std::vector<T>> at_start_;
  std::vector<errors_of_measure> errors_;
  std::optional<reference_along<T>> reference_;
  std::optional<reference_along<T>> finer_;
  std::optional<reference_along<T>> perturbed_;
};

// Methods beside the reference, along trajectories side by side.

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
  method_runs(const model& system, const nysalt::reference& reference, std::span<const tabulated> methods,
              double step, std::span<const error_measure> measures, const state& start, int count,
              const reference_checks& checks, const shared_noise& noise, const sample_weights& weights)
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
  using stepper_type = stepper<model, double, noise_type>;
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
