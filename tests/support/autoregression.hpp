// SPDX-License-Identifier: BSL-1.0
// A process whose memory is known: x_{t+1} = phi x_t + sqrt(1 - phi^2) xi_t with normal xi. It is stationary
// from the start, of mean 0 and variance 1, and rho(k) = phi^k.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::test {

/// Of the trajectories from the first on, in the lanes of T.
template <class T>
class autoregression {
 public:
  autoregression(double phi, std::uint64_t seed, std::uint64_t first)
      : phi_(phi), fresh_(std::sqrt(1.0 - phi * phi)), seed_(seed), at_{.trajectory = first} {
    at_.purpose = noise_purpose::initial_state;
    x_ = normal();
  }
  T next() {
    const T now = x_;
    x_ = x_ * phi_ + normal() * fresh_;
    return now;
  }

 private:
  T normal() {
    T number;
    standard_normals(seed_, at_, std::span<T>(&number, 1));
    ++at_.step;
    return number;
  }
  double phi_;
  double fresh_;
  std::uint64_t seed_;
  noise_counter at_;
  T x_;
};

/// From `groups` groups of 8 trajectories.
inline autocovariance autocovariance_of(double phi, std::uint64_t seed, int groups, int samples, int lags) {
  using T = pack<double, 8>;
  std::vector<detail::autocovariance_sums> sums;
  for (int group = 0; group < groups; ++group) {
    autoregression<T> process(phi, seed, static_cast<std::uint64_t>(8 * group));
    detail::autocovariance_along<T> along(lags, 0.0);
    for (int t = 0; t < samples; ++t) along.add(process.next());
    sums.push_back(along.in_lane(0));
    for (int k = 1; k < 8; ++k) {
      const auto lane_sums = along.in_lane(k);
      for (std::size_t lag = 0; lag < lane_sums.size(); ++lag)
        sums.back()[lag] = sums.back()[lag] + lane_sums[lag];
    }
  }
  return autocovariance(1.0, 0.0, sums);
}

}  // namespace nysalt::test
