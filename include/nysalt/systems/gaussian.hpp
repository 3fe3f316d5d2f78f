// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/core/fingerprint.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Independent oscillators of unit mass, V = sum over i of omega_i^2 q_i^2/2: exp(-V/kT) is the normal
/// density with the deviations sqrt(kT)/omega_i. For sampling in any dimension: a force costs one
/// multiplication a coordinate, and there is no matrix of modes (harmonic_oscillator and linear_chain have
/// one).
class gaussian {
 public:
  static constexpr int dimension = Eigen::Dynamic;

  /// A Gaussian with one frequency for each coordinate. Throws std::invalid_argument unless there is one, and
  /// all are positive and finite.
  explicit gaussian(const Eigen::VectorXd& frequencies) : stiffness_(frequencies.cwiseAbs2()) {
    if (frequencies.size() == 0 || !frequencies.allFinite() || !(frequencies.minCoeff() > 0.0)) {
      throw std::invalid_argument(sentence(
          "gaussian: frequencies must be positive and finite, one for each coordinate, got {} of them",
          frequencies.size()));
    }
    detail::fingerprint sum;
    sum.add_all(stiffness_);
    band_ = {frequencies.minCoeff(), frequencies.maxCoeff()};
    description_ = sentence("gaussian(size={}, omega_min={}, omega_max={}, fingerprint={})", size(),
                            band_.low, band_.high, sum.text());
  }

  Eigen::Index size() const { return stiffness_.size(); }

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i < size(); ++i) sum += q[i] * q[i] * (0.5 * stiffness_[i]);
    return sum;
  }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < size(); ++i) f[i] = q[i] * -stiffness_[i];
  }
  /// p += c f(q), in one pass.
  template <class T, class C>
  void kick(const vector<T, dimension>& q, vector<T, dimension>& p, const C& c) const {
    for (Eigen::Index i = 0; i < size(); ++i) p[i] += q[i] * -stiffness_[i] * c;
  }

  std::vector<frequency_band> frequency_bands() const { return {band_}; }
  /// Made once: it takes all frequencies.
  std::string description() const { return description_; }

 private:
  Eigen::VectorXd stiffness_;  // omega_i^2
  frequency_band band_{};
  std::string description_;
};

}  // namespace nysalt
