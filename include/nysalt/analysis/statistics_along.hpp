// SPDX-License-Identifier: BSL-1.0
// Statistics along trajectories in lanes, and the part of each that is kept.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "nysalt/analysis/autocovariance_sums.hpp"
#include "nysalt/analysis/histogram.hpp"
#include "nysalt/analysis/kinetic_temperature.hpp"

namespace nysalt {

/// The statistics of an ensemble that are wanted; others cost nothing.
struct statistics_wanted {
  std::optional<equal_bins> histogram = {};    ///< bins for the observable
  std::optional<int> lags = {};                ///< lags of the autocovariance
  bool moments = false;                        ///< mean and variance, with the effective sample size
  bool kinetic_temperature = false;            ///< kinetic temperature of the momenta at the steps
  bool half_step_kinetic_temperature = false;  ///< kinetic temperature between steps; costs a force a sample
  std::int64_t from = 0;                       ///< the first step that counts
};

/// Result of one trajectory: its means over time.
struct time_means {
  double first = 0.0;      ///< first moment: mean of the observable less the centre
  double second = 0.0;     ///< second moment: mean of the square of that difference
  double kinetic = 0.0;    ///< kinetic temperature at the steps
  double half_step = 0.0;  ///< kinetic temperature between steps
};

/// Number of values that read_sample() writes, 1 to 3.
inline std::size_t numbers_of_sample(const statistics_wanted& wanted) {
  return 1U + (wanted.kinetic_temperature ? 1U : 0U) + (wanted.half_step_kinetic_temperature ? 1U : 0U);
}

/// Writes the numbers of a sample: the observable, then the temperatures.
template <class T, class Stepper>
void read_sample(const statistics_wanted& wanted, const Stepper& stepper, const auto& observable,
                 const phase_point<T, Stepper::dimension>& x, std::span<T> numbers) {
  T* next = numbers.data();
  *next++ = value_in_lanes<T>(observable, x);
  if (wanted.kinetic_temperature) *next++ = kinetic_temperature<T>(stepper.system(), x);
  if (wanted.half_step_kinetic_temperature) {
    *next++ = half_step_kinetic_temperature<T>(stepper.system(), stepper.step_size(), x);
  }
}

/// Gathers what is wanted of the trajectories in the lanes of T. The bits of each do not depend on the lanes.
template <class T>
class statistics_along {
 public:
  /// Refers to what is wanted.
  statistics_along(const statistics_wanted& wanted, double centre) : wanted_(&wanted), centre_(centre) {
    if (wanted.histogram) histogram_.emplace(*wanted.histogram);
    if (wanted.lags) autocovariance_.emplace(*wanted.lags, centre);
  }

  /// Takes the sample at step n. A lane in which it is not finite is lost there.
  void add(std::int64_t n, std::span<const T> numbers, const condition_of<T>& live) {
    T all = numbers[0];
    for (const T& number : numbers.subspan(1)) all += number;
    const auto lost = both(!(all - all == T(0.0)), live);  // NOLINT(misc-redundant-expression): NaN, infinity
    lost_at_.take(lost, n);
    if (n < wanted_->from) return;
    samples_ += 1.0;
    if (histogram_) histogram_->add(numbers[0]);
    if (autocovariance_) autocovariance_->add(numbers[0]);
    std::size_t i = 1;
    if (wanted_->moments) add_moments(numbers[0] - centre_);
    if (wanted_->kinetic_temperature) kinetic_ += numbers[i++];
    if (wanted_->half_step_kinetic_temperature) half_step_ += numbers[i++];
  }

  /// The first step at which lane k was not finite.
  std::optional<std::int64_t> lost_at(int k) const { return lost_at_[k]; }
  /// The histogram of lane k, where one is wanted.
  const histogram& histogram_in_lane(int k) const { return histogram_->in_lane(k); }
  /// The autocovariance of lane k, where one is wanted. Throws like autocovariance_along::in_lane().
  autocovariance_sums autocovariance_in_lane(int k) { return autocovariance_->in_lane(k); }
  /// The means of lane k over its samples; 0 for what is not wanted.
  time_means means_in_lane(int k) const {
    return {lane(first_, k) / samples_, lane(second_, k) / samples_, lane(kinetic_, k) / samples_,
            lane(half_step_, k) / samples_};
  }

 private:
  void add_moments(const T& y) {
    first_ += y;
    second_ += y * y;
  }

  const statistics_wanted* wanted_;
  double centre_;
  double samples_ = 0.0;
  std::optional<histogram_along<T>> histogram_;
  std::optional<autocovariance_along<T>> autocovariance_;
  T first_{0.0};
  T second_{0.0};
  T kinetic_{0.0};
  T half_step_{0.0};
  first_in_lanes<T> lost_at_{};
};

}  // namespace nysalt
