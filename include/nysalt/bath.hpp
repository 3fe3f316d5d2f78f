// SPDX-License-Identifier: BSL-1.0
// A bath: friction, and the noise that belongs to it.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "nysalt/core/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Friction gamma and noise sigma: dp = force(q) dt - gamma p dt + sigma M^{1/2} dW, whose invariant density
/// is exp(-H/kT) with kT = sigma^2/(2 gamma) for any masses. Noise without friction is allowed; then there is
/// no temperature.
class bath {
 public:
  /// A bath from friction and sigma; there is a kT where there is friction. Throws std::invalid_argument
  /// unless both are finite and not negative.
  static bath of_sigma(double friction, double sigma) {
    require("friction", friction);
    require("sigma", sigma);
    return {friction, sigma, friction > 0.0 ? std::optional(sigma * sigma / (2.0 * friction)) : std::nullopt};
  }
  /// A bath from friction and kT, an energy: sigma = sqrt(2 gamma kT). Throws std::invalid_argument unless
  /// both are finite and not negative, and so is 2 gamma kT.
  static bath of_temperature(double friction, double temperature) {
    require("friction", friction);
    require("temperature", temperature);
    const double variance = 2.0 * friction * temperature;
    if (!std::isfinite(variance)) {
      throw std::invalid_argument(sentence(
          "bath: friction and temperature must have a finite product, got {} and {}", friction, temperature));
    }
    return {friction, std::sqrt(variance), temperature};
  }

  double friction() const { return friction_; }  ///< gamma, one over time
  double sigma() const { return sigma_; }        ///< sigma of the noise, for unit mass
  /// Whether kT is known: not without friction, unless it was given.
  bool has_temperature() const { return temperature_.has_value(); }
  /// Temperature kT, an energy. Throws std::domain_error where there is noise, or might be, but no friction.
  double temperature() const {
    if (temperature_) return *temperature_;
    throw std::domain_error(
        sentence("bath: friction must be > 0 for a temperature kT = sigma^2/(2 friction), got sigma = "
                 "{} and no friction",
                 sigma_));
  }

  /// Whether there is friction or noise; else a system in it moves as without it.
  bool acts() const { return friction_ > 0.0 || sigma_ > 0.0; }

  /// The damping factor of a momentum over a time: e^{-gamma t}.
  template <Scalar T>
  T decay(const T& time) const {
    using std::exp;
    return exp(time * -friction_);
  }
  /// Standard deviation, for unit mass, of the noise int_0^t sigma e^{-gamma (t - s)} dW_s:
  /// sigma sqrt((1 - e^{-2 gamma t})/(2 gamma)), which goes to sigma sqrt(t) with gamma to 0. Over dual
  /// numbers its derivative at t = 0 is the derivative of the limit: 0 along what leaves t at 0, and else
  /// infinite.
  template <Scalar T>
  T deviation(const T& time) const {
    using std::expm1;
    if (sigma_ == 0.0) return T(0.0);
    constexpr double least = std::numeric_limits<double>::min();  // below it 1/friction overflows
    if (friction_ < least) return root(time) * sigma_;
    return root(expm1(time * (-2.0 * friction_)) * (-0.5 / friction_)) * sigma_;
  }

  std::string description() const { return sentence("bath(friction={}, sigma={})", friction_, sigma_); }

 private:
  bath(double friction, double sigma, std::optional<double> temperature)
      : friction_(friction), sigma_(sigma), temperature_(temperature) {}
  /// sqrt(x), whose derivatives at 0 are 0 where the derivatives of x are 0, not 0/0.
  template <Scalar T>
  static T root(const T& x) {
    using std::sqrt;
    T result = sqrt(x);
    if constexpr (detail::is_dual_of_double<T>) {
      for (std::size_t k = 0; k < T::derivatives && x.value == 0.0; ++k) {
        if (x.derivative[k] == 0.0) result.derivative[k] = 0.0;
      }
    }
    return result;
  }
  static void require(const char* what, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw std::invalid_argument(
        sentence("bath: the {} must be finite and not negative, got {}", what, value));
  }

  double friction_;
  double sigma_;
  std::optional<double> temperature_;
};

/// A system that declares a bath.
template <class S>
concept HasBath = System<S> && requires(const S& s) {
  { s.bath() } -> std::convertible_to<const nysalt::bath&>;
};

}  // namespace nysalt
