// SPDX-License-Identifier: BSL-1.0
// Weights of the samples of a trajectory in a mean over time.
#pragma once

#include <cstdint>

namespace nysalt {

/// Weights of samples at t_i = i h, i = 0 .. n: all from the first on alike, or those of the mean over [0, T]
/// by the trapezoidal rule, T within the last step: what is sampled is linear between two samples, and its
/// part up to T counts. Then methods of other steps have means over the very same interval of time. For what
/// grows like t^k the rule errs by about k (k + 1)/12 of n^-2: by 0.5 % for k = 2 and ten samples.
class sample_weights {
 public:
  /// Equal weights of `samples` samples.
  explicit sample_weights(std::int64_t samples) : samples_(samples) {}

  /// Weights of the mean over [0, horizon]. Throws std::invalid_argument unless it ends within the last step.
  sample_weights(double step, std::int64_t samples, double horizon);

  /// Weight of sample i.
  double operator()(std::int64_t i) const {
    if (is_alike_) return i == 0 ? 0.0 : 1.0;
    double weight = 0.0;
    if (i > 0) weight += covered(i) * covered(i) / 2.0;
    if (i < samples_) weight += covered(i + 1) * (1.0 - covered(i + 1) / 2.0);
    return weight;
  }

  /// Their sum.
  double total() const { return static_cast<double>(samples_) - (is_alike_ ? 0.0 : 1.0 - last_); }

 private:
  /// Share of the step before sample i that counts.
  double covered(std::int64_t i) const { return i == samples_ ? last_ : 1.0; }

  std::int64_t samples_;
  bool is_alike_ = true;
  double last_ = 1.0;
};

}  // namespace nysalt
