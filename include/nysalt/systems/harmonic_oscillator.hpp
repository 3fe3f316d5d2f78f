// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// H = p^2/2 + omega^2 q^2/2.
class harmonic_oscillator {
 public:
  static constexpr int dimension = 1;

  /// Throws std::invalid_argument unless omega is positive and finite.
  explicit harmonic_oscillator(double omega) : omega_(omega) {
    if (!(omega > 0.0) || !std::isfinite(omega)) {
      throw std::invalid_argument(
          sentence("harmonic_oscillator: omega must be positive and finite, got {}", omega));
    }
  }

  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * (0.5 * omega_ * omega_);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * (-omega_ * omega_);
  }

  double omega() const { return omega_; }  ///< angular frequency
  normal_modes modes() const {
    return {Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Constant(1, omega_)};
  }
  std::vector<frequency_band> frequency_bands() const { return {{omega_, omega_}}; }
  std::string description() const { return sentence("harmonic_oscillator(omega={})", omega_); }

 private:
  double omega_;
};

}  // namespace nysalt
