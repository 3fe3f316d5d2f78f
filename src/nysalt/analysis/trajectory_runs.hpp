// SPDX-License-Identifier: BSL-1.0
// Runs of methods and of their reference side by side, and the errors that are measured on them.
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
#include "nysalt/core/sentence.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/method.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/stepping/lockstep.hpp"

namespace nysalt::detail {

/// Scores of the trajectories of one method; NaN, and the step, for a trajectory that diverged.
struct scores_of_method {
  std::vector<double> scores;
  std::vector<std::optional<std::int64_t>> diverged_at;
};

/// What was measured of all trajectories by one measure.
struct measured_errors {
  std::vector<scores_of_method> methods;
  std::vector<double> checks;  // errors of the reference against its finer self, on the first trajectories
  std::vector<double> null_model;         // empty if it is not wanted
  std::vector<double> predictable_until;  // times, on the first trajectories; empty if they are not wanted
  std::vector<double> sizes;              // means over time of what errors are relative to
  std::vector<double> signs;              // of scales; 0 where there is none
};

/// What is compared: methods with a reference, by measures whose numbers lie one after the other.
struct comparison {
  const nysalt::reference& reference;
  std::span<const method> methods;
  std::span<const error_measure> measures;
  const trajectory_options& options;
  std::int64_t checked;    // number of trajectories on which the reference is compared with a finer one
  std::int64_t perturbed;  // number of trajectories on which it is compared with a run from a perturbed start
  int parts;               // of a step, in which methods need the noise of a path; 0: there is none
  sample_weights weights;
  std::vector<std::size_t> begins;  // of the numbers of each measure among those of all, and where they end

  std::size_t width() const { return begins.back(); }
  bool needs_reference() const { return std::ranges::any_of(measures, &error_measure::needs_reference); }
  /// The numbers of measure i among all that are read of a state.
  template <class Number>
  std::span<Number> part(std::size_t i, std::span<Number> all) const {
    return all.subspan(begins[i], measures[i].width);
  }
  /// Reads the numbers of all measures, or of those that need a reference.
  template <class T>
  void read(const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers, bool of_all = true) const {
    for (std::size_t i = 0; i < measures.size(); ++i) {
      if (of_all || measures[i].needs_reference) measures[i].read(x, part(i, numbers));
    }
  }
};

/// Trajectories first .. first + count - 1 from their starts on, one in each lane of T.
template <class T>
struct block_of_starts {
  const model& system;
  phase_point<T, Eigen::Dynamic> start;
  std::int64_t first;
  int count;
};

/// Readings of measures along a reference, an interval of samples at a time. In a bath the noise of that
/// interval is kept for the methods that follow.
template <class T>
class reference_along {
 public:
  using state = phase_point<T, Eigen::Dynamic>;        ///< states of all lanes
  using path_type = recorded_path<T, Eigen::Dynamic>;  ///< noise, in parts of a step

  /// Refers to what is compared, the block, the reference and the path, to which the noise of each step is
  /// added; from other starts than those of the block, on its noise.
  reference_along(const comparison& compared, const block_of_starts<T>& block,
                  const nysalt::reference& reference, const state& start, path_type* path = nullptr)
      : compared_(&compared),
        block_(&block),
        description_(reference.description()),
        run_(reference.open(block.system, start,
                            {.length = compared.options.step,
                             .count = block.count,
                             .at = {compared.options.seed, static_cast<std::uint64_t>(block.first), 0},
                             .noise_parts = path == nullptr ? 0 : compared.parts})),
        path_(path),
        signs_(compared.measures.size()) {}

  /// Reads the next `samples`, each a step after the last. What is not sound is remembered.
  void go_on(std::int64_t samples) {
    from_ = step_ + 1;
    numbers_.resize(static_cast<std::size_t>(samples) * compared_->width());
    // A letter O that ends the step before the interval is still to come.
    if (path_ != nullptr) path_->forget_before((step_ - 1) * std::ssize(run_->noise()));
    for (std::int64_t i = 0; i < samples; ++i) {
      run_->advance();
      for (const auto& xi : run_->noise()) path_->add(xi);
      ++step_;
      const auto here =
          std::span(numbers_).subspan(static_cast<std::size_t>(i) * compared_->width(), compared_->width());
      compared_->read(run_->state(), here, false);
      inspect(here);
    }
  }

  /// The numbers of measure i at sample n of the last interval.
  std::span<const T> at(std::size_t i, std::int64_t n) const {
    const auto begin = static_cast<std::size_t>(n - from_) * compared_->width();
    return compared_->part(i, std::span(numbers_).subspan(begin, compared_->width()));
  }

  /// The sign of the scale of a measure in lane k; 0 where it has none.
  double sign(std::size_t measure, int k) const { return signs_[measure][static_cast<std::size_t>(k)]; }

  /// Throws for the first trajectory that came to grief: std::runtime_error where the reference, or what is
  /// read of it, is not finite; std::invalid_argument where a measure has no scale, or one that changes sign.
  void require_sound() const {
    for (int k = 0; k < block_->count; ++k) {
      const auto& first_failure = failures_[static_cast<std::size_t>(k)];
      if (!first_failure) continue;
      const auto& measure = compared_->measures[first_failure->measure];
      if (first_failure->without_scale) throw std::invalid_argument(measure.no_scale);
      throw std::runtime_error(
          sentence("trajectory {} of the reference ({}), and what the {} error reads of it, must be finite, "
                   "got another number at step {}; take other starts, a finer reference or a shorter horizon",
                   block_->first + k, description_, measure.name, first_failure->step));
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
    for (std::size_t i = 0; i < compared_->measures.size(); ++i) {
      const error_measure& measure = compared_->measures[i];
      const auto here = compared_->part(i, all);
      auto sound = finite;
      for (const T& number : here) {
        sound = both(sound, number - number == T(0.0));  // NOLINT(misc-redundant-expression): NaN, infinity
      }
      std::optional<T> scale;
      if (measure.needs_reference && measure.scale) scale = measure.scale(here);
      for (int k = 0; k < block_->count; ++k) {
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

  const comparison* compared_;
  const block_of_starts<T>* block_;
  std::string description_;  // of the reference
  std::unique_ptr<reference_run<T>> run_;
  std::int64_t step_ = 0;  // steps done
  std::int64_t from_ = 0;  // the first step of the interval
  path_type* path_;
  std::vector<T> numbers_;
  std::array<std::optional<failure>, static_cast<std::size_t>(lanes_in<T>)> failures_{};
  std::vector<std::array<double, static_cast<std::size_t>(lanes_in<T>)>>
      signs_;  // of the scale of each measure
};

/// Methods beside the reference, from the same starts and with its noise. Beside it go also the reference's
/// finer self, one from perturbed starts on the same noise, and the null model in which all stays as it was
/// at the start; each only as far as it is wanted. All measures read the same runs.
template <class T>
class compared_block {
 public:
  /// Refers to what is compared, and to itself.
  compared_block(const comparison& compared, const block_of_starts<T>& block)
      : compared_(compared),
        block_(block),
        live_(first_lanes<T>(block.count)),
        at_start_(compared.width()),
        path_(std::abs(compared.options.step) / std::max(compared.parts, 1), block.system.bath().friction(),
              static_cast<std::uint64_t>(block.first)) {
    compared.read(block_.start, std::span<T>(at_start_));
    std::vector<errors_along<T>> none;
    for (std::size_t i = 0; i < compared.measures.size(); ++i) {
      const error_measure& measure = compared.measures[i];
      none.emplace_back(measure, compared.weights(0));
      of_reference_.push_back({none[i], none[i], none[i], predictable_samples<T>(measure.how)});
      if (!measure.needs_reference && measure.scale) require_scale(measure, starts_of(i));
      if (measure.relative_to) {  // of what needs no reference that is all
        const double weight = measure.needs_reference ? compared.weights(0) : compared.weights.total();
        of_reference_[i].size = measure.relative_to(starts_of(i)) * weight;
      }
    }
    open_references();
    methods_.reserve(compared.methods.size());
    for (const nysalt::method& method : compared.methods) {
      const auto covered = compared.parts == 0 ? noise_intervals()
                                               : intervals_of_noise(method.letters(), method.coefficients());
      methods_.push_back({make_stepper(block.system, method, compared.options.step,
                                       noise_type(path_, covered, compared.options.step)),
                          {},
                          {*this, none}});
      methods_.back().run.emplace(methods_.back().stepper, block_.start, block.count, block.first);
    }
  }
  compared_block(const compared_block&) = delete;
  compared_block& operator=(const compared_block&) = delete;

  /// Follows the reference and all methods, one interval after the other, so that no path is kept. Throws
  /// like reference_along.
  void run() {
    const std::int64_t steps = compared_.options.steps;
    for (std::int64_t done = 0; done < steps; done += steps_between_checks) {
      const std::int64_t next = std::min(done + steps_between_checks, steps);
      for (auto* run : {&reference_, &finer_, &perturbed_}) {
        if (*run) (*run)->go_on(next - done);
      }
      for (std::int64_t n = done + 1; n <= next; ++n) compare_references(n);
      for (auto& method : methods_) method.run->go_on(next, 1, method.errors);
    }
    if (reference_) reference_->require_sound();
    if (finer_) finer_->require_sound();
  }

  /// Puts what was measured into the places of its trajectories, after run().
  void store(std::vector<measured_errors>& found) const {
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (int k = 0; k < block_.count; ++k) store(i, k, found[i]);
    }
  }

 private:
  using noise_type = along_path<T, Eigen::Dynamic>;
  using stepper_type = stepper<model, double, noise_type>;

  /// The errors of a method by all measures, as a Measure.
  struct errors_of_method {
    const compared_block& block;
    std::vector<errors_along<T>> along;

    std::size_t width() const { return block.compared_.width(); }
    void read(const phase_point<T, Eigen::Dynamic>& x, std::span<T> numbers) const {
      block.compared_.read(x, numbers);
    }
    void see(std::int64_t n, std::span<const T> seen, const condition_of<T>& live) {
      for (std::size_t i = 0; i < along.size(); ++i) {
        along[i].see(n, block.compared_.part(i, seen), block.expected(i, n), live,
                     block.compared_.weights(n));
      }
    }
  };
  struct method_beside {
    stepper_type stepper;
    std::optional<lockstep<stepper_type, T>> run;
    errors_of_method errors;
  };
  struct errors_of_reference {
    errors_along<T> finer;
    errors_along<T> null_model;
    errors_along<T> perturbed;
    predictable_samples<T> predictable;
    T size{0.0};  // what the errors are relative to, summed over time
  };

  std::span<const T> starts_of(std::size_t i) const {
    return compared_.part(i, std::span<const T>(at_start_));
  }
  std::span<const T> expected(std::size_t i, std::int64_t n) const {
    return compared_.measures[i].needs_reference ? reference_->at(i, n) : starts_of(i);
  }
  bool has(std::int64_t trajectories) const { return block_.first < trajectories; }

  void open_references() {
    const bool is_needed = compared_.needs_reference();
    if (is_needed || compared_.parts > 0) {
      reference_.emplace(compared_, block_, compared_.reference, block_.start, &path_);
    }
    if (is_needed && has(compared_.checked)) {
      finer_.emplace(compared_, block_, compared_.reference.finer(), block_.start);
    }
    if (is_needed && has(compared_.perturbed)) {
      perturbed_.emplace(compared_, block_, compared_.reference,
                         perturbed(block_.start, *compared_.options.perturbation, compared_.options.seed,
                                   static_cast<std::uint64_t>(block_.first)));
    }
  }

  void compare_references(std::int64_t n) {
    const double weight = compared_.weights(n);
    for (std::size_t i = 0; i < of_reference_.size(); ++i) {
      const error_measure& measure = compared_.measures[i];
      if (!measure.needs_reference) continue;
      errors_of_reference& errors = of_reference_[i];
      const auto exact = reference_->at(i, n);
      if (measure.relative_to) errors.size += measure.relative_to(exact) * weight;
      if (finer_) errors.finer.see(n, exact, finer_->at(i, n), live_, weight);
      if (compared_.options.null_model || perturbed_) {
        errors.null_model.see(n, starts_of(i), exact, live_, weight);
      }
      if (!perturbed_) continue;
      errors.perturbed.see(n, perturbed_->at(i, n), exact, live_, weight);
      errors.predictable.add(n, errors.perturbed.sum(), errors.null_model.sum());
    }
  }

  void require_scale(const error_measure& measure, std::span<const T> at_start) const {
    const T scale = measure.scale(at_start);
    for (int k = 0; k < block_.count; ++k) {
      if (lane(scale, k) == 0.0) throw std::invalid_argument(measure.no_scale);
    }
  }

  double sign(std::size_t i, int k) const {
    const error_measure& measure = compared_.measures[i];
    if (!measure.scale) return 0.0;
    if (measure.needs_reference) return reference_->sign(i, k);
    return std::copysign(1.0, lane(measure.scale(starts_of(i)), k));
  }

  void store(std::size_t i, int k, measured_errors& found) const {
    const auto slot = static_cast<std::size_t>(block_.first + k);
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      const errors_along<T>& errors = methods_[m].errors.along[i];
      const auto lost_at = errors.lost_at(k) ? errors.lost_at(k) : methods_[m].run->diverged_at(k);
      found.methods[m].scores[slot] = lost_at ? std::nan("") : errors.score(k);
      found.methods[m].diverged_at[slot] = lost_at;
    }
    const errors_of_reference& errors = of_reference_[i];
    if (slot < found.checks.size()) found.checks[slot] = errors.finer.score(k);
    if (slot < found.predictable_until.size()) {
      found.predictable_until[slot] = errors.predictable.until(k) * std::abs(compared_.options.step);
    }
    if (slot < found.null_model.size()) found.null_model[slot] = errors.null_model.score(k);
    found.sizes[slot] = lane(errors.size, k) / compared_.weights.total();
    found.signs[slot] = sign(i, k);
  }

  const comparison& compared_;
  const block_of_starts<T>& block_;
  condition_of<T> live_;
  std::vector<T> at_start_;
  std::vector<errors_of_reference> of_reference_;  // one a measure
  recorded_path<T, Eigen::Dynamic> path_;          // of the present interval
  std::optional<reference_along<T>> reference_;
  std::optional<reference_along<T>> finer_;
  std::optional<reference_along<T>> perturbed_;
  std::vector<method_beside> methods_;
};

}  // namespace nysalt::detail
