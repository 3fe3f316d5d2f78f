// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <concepts>
#include <stdexcept>
#include <string>
#include <typeinfo>

#include "nysalt/core/sentence.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Whether V(q, t) can be evaluated over T: a struct with `dimension` and a template potential(q, t).
template <class P, class T>
concept HasPotentialInTime = requires(const P& p, const vector<T, P::dimension>& q, const T& t) {
  { p.potential(q, t) } -> std::same_as<T>;
};

/// H = K(p) + V(q, t): a system whose drifts carry the time. A user writes V as
///   static constexpr int dimension = N;
///   template <class T> T potential(const vector<T, N>& q, const T& t) const;
///   double inverse_mass(Eigen::Index i) const;      if wanted
///   std::string description() const;                if wanted
/// and states at a time by state(x, t). Inside, the time is a further coordinate of speed 1, whose momentum
/// takes up what the energy of the rest changes by: H + p_t is conserved, and 0 of what state() makes. K is
/// not quadratic then: letters G and D, methods whose order needs a quadratic K, and baths are refused.
/// Source: [hairer_lubich_wanner_2006, section VI.1].
template <class P>
  requires(P::dimension > 0 && HasPotentialInTime<P, double>)
class in_time {
 public:
  static constexpr int dimension = P::dimension + 1;
  using point = phase_point<double, P::dimension>;  ///< a state without its time

  /// The system that P describes.
  explicit in_time(const P& driven = {}) : driven_(driven) {}

  const P& driven() const { return driven_; }  ///< the system P with time
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    vector<T, P::dimension> x;
    for (int i = 0; i < P::dimension; ++i) x[i] = q[i];
    return driven_.potential(x, q[P::dimension]);
  }
  /// v = p/m, and 1 of the time.
  template <class T>
  void velocity(const vector<T, dimension>& p, vector<T, dimension>& v) const {
    for (int i = 0; i < P::dimension; ++i) v[i] = p[i] * inverse_mass_of(i);
    v[P::dimension] = T(1.0);
  }
  /// K = sum p^2/2m + p_t.
  template <class T>
  T kinetic_energy(const vector<T, dimension>& p) const {
    T sum = p[P::dimension];
    for (int i = 0; i < P::dimension; ++i) sum += p[i] * p[i] * (0.5 * inverse_mass_of(i));
    return sum;
  }

  /// The state x at the time t. Throws std::invalid_argument unless the time is finite.
  phase_point<double, dimension> state(const point& x, double t) const {
    if (!std::isfinite(t))
      throw std::invalid_argument(sentence("in_time: the time must be finite, got {}", t));
    phase_point<double, dimension> result;
    result.q << x.q, t;
    result.p << x.p, 0.0;
    result.p[P::dimension] = -(kinetic_energy(result.p) + potential(result.q));
    return result;
  }
  /// The time of a state.
  static double time(const phase_point<double, dimension>& x) { return x.q[P::dimension]; }
  /// The state without its time.
  static point at_its_time(const phase_point<double, dimension>& x) {
    return {x.q.template head<P::dimension>(), x.p.template head<P::dimension>()};
  }
  std::string description() const {
    if constexpr (requires { driven_.description(); }) {
      return driven_.description() + " in time";
    } else {
      return detail::name_of_type(typeid(P)) + " in time";
    }
  }

 private:
  double inverse_mass_of(Eigen::Index i) const {
    if constexpr (requires { driven_.inverse_mass(i); }) {
      return driven_.inverse_mass(i);
    } else {
      return 1.0;
    }
  }
  P driven_;
};

/// A pendulum under a periodic torque: V = -cos q - amplitude q cos(frequency t).
class driven_pendulum {
 public:
  static constexpr int dimension = 1;

  /// Throws std::invalid_argument unless both are finite.
  driven_pendulum(double amplitude, double frequency) : amplitude_(amplitude), frequency_(frequency) {
    if (!std::isfinite(amplitude) || !std::isfinite(frequency)) {
      throw std::invalid_argument(sentence(
          "driven_pendulum: amplitude and frequency must be finite, got {} and {}", amplitude, frequency));
    }
  }
  template <class T>
  T potential(const vector<T, 1>& q, const T& t) const {
    using std::cos;
    return -cos(q[0]) - q[0] * cos(t * frequency_) * amplitude_;
  }
  std::string description() const {
    return sentence("driven_pendulum(amplitude={}, frequency={})", amplitude_, frequency_);
  }

 private:
  double amplitude_;
  double frequency_;
};

}  // namespace nysalt
