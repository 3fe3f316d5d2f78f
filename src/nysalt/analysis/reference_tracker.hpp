// SPDX-License-Identifier: BSL-1.0
// The reference that methods are compared with, and what it is compared with itself.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/error_sum.hpp"
#include "nysalt/analysis/predictability.hpp"
#include "nysalt/analysis/sample_weights.hpp"
#include "reference_along.hpp"

namespace nysalt {

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
  reference_tracker(const model& system, const detail::reference_value& reference,
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
      reference_.emplace(system, reference, measures_, start, count, at, &path, noise_parts);
    }
    if (needed && checks.finer > 0) {
      finer_reference_.emplace(reference.finer());
      finer_.emplace(system, *finer_reference_, measures_, start, checks.finer, at);
    }
    if (needed && checks.perturbed > 0 && checks.perturbation) {
      const auto from = nysalt::perturbed(start, *checks.perturbation, at.seed, at.trajectory);
      perturbed_.emplace(system, reference, measures_, from, checks.perturbed, at);
    }
  }

  reference_tracker(const reference_tracker&) = delete;
  reference_tracker& operator=(const reference_tracker&) = delete;

  /// Goes on through the samples from + 1 .. to.
  void go_on(std::int64_t from, std::int64_t to) {
    from_ = from;
    if (reference_) reference_->go_on(step_, to - from);
    if (finer_) finer_->go_on(step_, to - from);
    if (perturbed_) perturbed_->go_on(step_, to - from);
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
  std::optional<detail::reference_value> finer_reference_;
  std::optional<reference_along<T>> finer_;
  std::optional<reference_along<T>> perturbed_;
};

}  // namespace nysalt
