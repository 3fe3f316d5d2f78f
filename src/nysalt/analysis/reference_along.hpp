// SPDX-License-Identifier: BSL-1.0
// Readings of measures along a reference.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "joined_measures.hpp"
#include "nysalt/detail/any_reference.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/noises/recorded_path.hpp"

namespace nysalt {

/// Readings of measures along a reference, an interval of samples at a time; one trajectory in each lane. In
/// a bath the noise of that interval is kept for the methods that follow.
template <class T>
class reference_along {
 public:
  using state = phase_point<T, Eigen::Dynamic>;        ///< states of all lanes
  using path_type = recorded_path<T, Eigen::Dynamic>;  ///< noise, in parts of a step

  /// Refers to system, reference, measures and path. `count` lanes hold a trajectory, that in lane 0 is the
  /// place's. The noise of each step is added to the path in `parts` parts.
  reference_along(const model& system, const detail::reference_value& reference,
                  const joined_measures& measures, const state& start, int count, const path_place& at = {},
                  path_type* path = nullptr, int noise_parts = 0)
      : system_(&system),
        reference_(&reference),
        measures_(&measures),
        x_(start),
        count_(count),
        at_(at),
        path_(path),
        noise_(static_cast<std::size_t>(noise_parts), make_vector<T>(system)),
        signs_(measures.size()) {}

  /// Reads the next `samples`, each a time `step` after the last. What is not sound is remembered.
  void go_on(double step, std::int64_t samples) {
    const std::size_t width = measures_->width();
    numbers_.resize(static_cast<std::size_t>(samples) * width);
    // A letter O that ends the step before the interval is still to come.
    if (path_ != nullptr) path_->forget_before((at_.step - 1) * std::ssize(noise_));
    for (std::int64_t i = 0; i < samples; ++i) {
      if (!flow_) flow_ = reference_->template prepare<T>(*system_, step);
      flow_->advance(x_, count_, at_, noise_);
      for (const auto& xi : noise_) path_->add(xi);
      ++at_.step;
      const auto here = std::span(numbers_).subspan(static_cast<std::size_t>(i) * width, width);
      measures_->read(x_, here);
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
                   first + k, reference_->description(), measure.name, first_failure->step));
    }
  }

 private:
  struct failure {
    std::int64_t step;
    std::size_t measure;
    bool without_scale;
  };

  void inspect(std::span<const T> all) {
    const auto finite = is_finite(x_);
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
        first_failure = failure{at_.step, i, lane(sound, k)};
      }
    }
  }

  /// Whether the scale has the sign that it had before; not where the scale is 0.
  bool keeps_sign(std::size_t measure, int k, double scale) {
    double& known_sign = signs_[measure][static_cast<std::size_t>(k)];
    if (known_sign == 0.0) known_sign = scale > 0.0 ? 1.0 : scale < 0.0 ? -1.0 : 0.0;
    return known_sign * scale > 0.0 || std::isnan(scale);
  }

  const model* system_;
  const detail::reference_value* reference_;
  const joined_measures* measures_;
  state x_;
  int count_;
  path_place at_;
  path_type* path_;
  std::vector<vector<T, Eigen::Dynamic>> noise_;
  std::vector<T> numbers_;
  std::unique_ptr<detail::reference_run<T>> flow_;
  std::array<std::optional<failure>, static_cast<std::size_t>(lanes_in<T>)> failures_{};
  std::vector<std::array<double, static_cast<std::size_t>(lanes_in<T>)>>
      signs_;  // of the scale of each measure
};

}  // namespace nysalt
