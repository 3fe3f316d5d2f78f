// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "nysalt/core/sentence.hpp"
#include "nysalt/flows/sum_of_parts.hpp"

namespace examples {

using namespace nysalt;

/// N masses in a row, q_i from their places i, held by stiff bonds: V = omega^2/2 sum (q_{i+1} - q_i)^2. The
/// cheap part of a bonded_chain: O(N), and frequencies up to 2 omega.
template <int N>
  requires(N >= 2)
class stiff_bonds {
 public:
  static constexpr int dimension = N;

  /// Throws std::invalid_argument unless omega is positive and finite.
  explicit stiff_bonds(double omega) : omega_(omega) {
    if (!(omega > 0.0) || !std::isfinite(omega)) {
      throw std::invalid_argument(sentence("stiff_bonds: omega must be positive and finite, got {}", omega));
    }
  }

  template <class T>
  T potential(const vector<T, N>& q) const {
    T sum(0.0);
    for (int i = 0; i + 1 < N; ++i) {
      const T elongation = q[i + 1] - q[i];
      sum += elongation * elongation;
    }
    return sum * (0.5 * omega_ * omega_);
  }
  template <class T>
  void force(const vector<T, N>& q, vector<T, N>& f) const {
    for (int i = 0; i < N; ++i) f[i] = T(0.0);
    for (int i = 0; i + 1 < N; ++i) {
      const T pull = (q[i + 1] - q[i]) * (omega_ * omega_);
      f[i] += pull;
      f[i + 1] -= pull;
    }
  }
  double omega() const {
    return omega_;
  }  ///< frequency of one bond with unit masses at its ends: sqrt(2) omega
  std::string description() const { return sentence("stiff_bonds({}, omega={})", N, omega_); }

 private:
  double omega_;
};

/// The masses of a bonded_chain as charges of one sign, in a harmonic trap around their places:
///   V = sum q_i^2/2 + strength sum_{i<j} (1 + r^2)^(-1/2),  r = j + q_j - i - q_i.
/// The expensive part of a bonded_chain: O(N^2), and frequencies of order one.
template <int N>
class soft_charges {
 public:
  static constexpr int dimension = N;

  /// Throws std::invalid_argument unless the strength is finite.
  explicit soft_charges(double strength) : strength_(strength) {
    if (!std::isfinite(strength)) {
      throw std::invalid_argument(sentence("soft_charges: the strength must be finite, got {}", strength));
    }
  }

  template <class T>
  T potential(const vector<T, N>& q) const {
    using std::sqrt;
    T sum(0.0);
    for (int i = 0; i < N; ++i) {
      sum += q[i] * q[i] * 0.5;
      for (int j = i + 1; j < N; ++j) {
        const T r = q[j] - q[i] + T(static_cast<double>(j - i));
        sum += T(strength_) / sqrt(T(1.0) + r * r);
      }
    }
    return sum;
  }
  template <class T>
  void force(const vector<T, N>& q, vector<T, N>& f) const {
    using std::sqrt;
    for (int i = 0; i < N; ++i) f[i] = -q[i];
    for (int i = 0; i < N; ++i) {
      for (int j = i + 1; j < N; ++j) {
        const T r = q[j] - q[i] + T(static_cast<double>(j - i));
        const T square = T(1.0) + r * r;
        const T push = r * strength_ / (square * sqrt(square));
        f[i] -= push;
        f[j] += push;
      }
    }
  }
  std::string description() const { return sentence("soft_charges({}, strength={})", N, strength_); }

 private:
  double strength_;
};

/// Part 0 is fast and cheap, part 1 slow and expensive: a case for multiple time steps.
template <int N>
using bonded_chain = sum_of_parts<stiff_bonds<N>, soft_charges<N>>;

}  // namespace examples
