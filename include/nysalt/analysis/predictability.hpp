// SPDX-License-Identifier: BSL-1.0
// Horizon of predictability: until a slightly wrong start is hardly better than no model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/noises/counter_based.hpp"

namespace nysalt {

/// All coordinates times 1 + relative * (normal numbers of their own), each a pure function of seed and
/// trajectory; lane 0 holds number `first`. What is 0 stays so.
template <class T, int N>
phase_point<T, N> perturbed(phase_point<T, N> x, double relative, std::uint64_t seed, std::uint64_t first) {
  phase_point<T, N> normals = x;
  noise_counter at = {.trajectory = first, .purpose = noise_purpose::perturbation};
  standard_normals(seed, at, normals.q);
  at.slot += slots_for(static_cast<std::uint64_t>(x.size()));
  standard_normals(seed, at, normals.p);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x.q[i] = x.q[i] * (normals.q[i] * relative + 1.0);
    x.p[i] = x.p[i] * (normals.p[i] * relative + 1.0);
  }
  return x;
}

/// Number of the sample, in each lane, since which the errors of perturbed starts so far exceed half of the
/// null model's, to the end: a quarter of them where they are squares, so that roots are halved. A sum that
/// falls behind again begins anew: what hardly moves at first leaves the null model without errors for a few
/// samples.
template <class T>
class predictable_samples {
 public:
  /// `how` says whether sums of errors are of squares: all but averaging::mean.
  explicit predictable_samples(averaging how) : share_(how == averaging::mean ? 0.5 : 0.25) {}

  /// Takes the sums of errors over the samples up to i = 1, 2, ..., in this order.
  void add(std::int64_t i, const T& perturbed, const T& null_model) {
    const auto within = perturbed <= null_model * share_;  // not if a sum has gone to NaN
    exceeded_at_.reset(within);
    exceeded_at_.take(!within, i);
  }

  /// The first sample in lane k from which on the errors are not within; infinite if they are to the end.
  double until(int k) const {
    const auto& exceeded_at = exceeded_at_[k];
    return exceeded_at ? static_cast<double>(*exceeded_at) : std::numeric_limits<double>::infinity();
  }

 private:
  double share_;
  first_in_lanes<T> exceeded_at_{};
};

}  // namespace nysalt
