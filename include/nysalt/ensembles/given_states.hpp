// SPDX-License-Identifier: BSL-1.0
// Initial distributions around a given state, and given states themselves.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// Every coordinate normal and independent around a centre, with one deviation for q and one for p.
template <int N>
class normal_around {
 public:
  /// Throws std::invalid_argument if the centre is not finite or a deviation is negative or not finite.
  normal_around(phase_point<double, N> centre, double deviation_q, double deviation_p)
      : centre_(std::move(centre)), deviation_q_(deviation_q), deviation_p_(deviation_p) {
    if (!is_finite(centre_) || centre_.q.size() != centre_.p.size() || !(deviation_q >= 0.0) ||
        !(deviation_p >= 0.0) || !std::isfinite(deviation_q) || !std::isfinite(deviation_p)) {
      throw std::invalid_argument(
          "normal_around: centre must be finite, with as many q as p, and deviations must be "
          "finite and >= 0");
    }
  }

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    phase_point<double, N> start = centre_;
    phase_point<double, N> normals = centre_;
    noise_counter at = {.trajectory = n, .purpose = noise_purpose::initial_state};
    standard_normals(seed, at, normals.q);
    at.slot += detail::slots_for(static_cast<std::uint64_t>(start.size()));
    standard_normals(seed, at, normals.p);
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      start.q[i] += deviation_q_ * normals.q[i];
      start.p[i] += deviation_p_ * normals.p[i];
    }
    return start;
  }
  std::string description() const { return sentence("normal_around({}, {})", deviation_q_, deviation_p_); }

 private:
  phase_point<double, N> centre_;
  double deviation_q_;
  double deviation_p_;
};

/// Given states, in their order; the seed is of no account.
template <int N>
class listed {
 public:
  /// Trajectory n starts at states[n].
  explicit listed(std::vector<phase_point<double, N>> states) : states_(std::move(states)) {}

  /// Throws std::out_of_range beyond the last state.
  phase_point<double, N> operator()(std::uint64_t, std::uint64_t n) const {
    if (n >= states_.size()) {
      throw std::out_of_range(sentence("listed: an initial state must be in the list, got number {} of {}",
                                       n + 1, states_.size()));
    }
    return states_[n];
  }
  std::size_t size() const { return states_.size(); }  ///< number of states
  std::string description() const { return sentence("listed({} states)", states_.size()); }

 private:
  std::vector<phase_point<double, N>> states_;
};

}  // namespace nysalt
