// SPDX-License-Identifier: BSL-1.0
// Textbook problems of one or two degrees of freedom.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/core/sentence.hpp"
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

/// H = p^2/2 - cos q: unit mass, length and gravity [hairer_lubich_wanner_2006, section I.1.2].
struct pendulum {
  static constexpr int dimension = 1;

  template <class T>
  T potential(const vector<T, 1>& q) const {
    using std::cos;
    return -cos(q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    using std::sin;
    f[0] = -sin(q[0]);
  }

  /// Up to 1, that at the bottom: oscillations grow slower with their amplitude.
  std::vector<frequency_band> frequency_bands() const { return {{0.0, 1.0}}; }
  std::string description() const { return "pendulum()"; }
};

/// H = (p_1^2 + p_2^2)/2 + (q_1^2 + q_2^2)/2 + q_1^2 q_2 - q_2^3/3, bounded below energy 1/6
/// [henon_heiles_1964].
struct henon_heiles {
  static constexpr int dimension = 2;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) * 0.5 + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] * (1.0 / 3.0);
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = -q[0] - q[0] * q[1] * 2.0;
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  }

  /// The force of the cubic part only.
  template <class T>
  void soft_force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = q[0] * q[1] * -2.0;
    f[1] = q[1] * q[1] - q[0] * q[0];
  }

  /// Both modes of the quadratic part have frequency 1.
  normal_modes modes() const { return {Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Ones(2)}; }
  /// The Hessian has eigenvalues 1 +- 2 |q|, and |q| <= 1 on bounded orbits.
  std::vector<frequency_band> frequency_bands() const { return {{0.0, std::sqrt(3.0)}}; }
  std::string description() const { return "henon_heiles()"; }
};

/// The Kepler problem in the plane, a unit mass drawn to the origin: H = (p_1^2 + p_2^2)/2 - 1/|q|
/// [hairer_lubich_wanner_2006, section I.2]. An ellipse of semi-major axis 1 has period 2 pi. Near the
/// centre the motion is as fast as |q|^{-3/2}: there is no highest frequency, and no bands are declared.
struct kepler {
  static constexpr int dimension = 2;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::sqrt;
    return T(-1.0) / sqrt(q[0] * q[0] + q[1] * q[1]);
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    using std::sqrt;
    const T square = q[0] * q[0] + q[1] * q[1];
    const T pull = T(-1.0) / (square * sqrt(square));
    f[0] = q[0] * pull;
    f[1] = q[1] * pull;
  }

  std::string description() const { return "kepler()"; }
};

}  // namespace nysalt
