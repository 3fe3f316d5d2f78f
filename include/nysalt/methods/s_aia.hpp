// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "nysalt/methods/palindromic.hpp"
#include "nysalt/requirements.hpp"
#include "nysalt/sentence.hpp"

namespace nysalt {

namespace detail {

/// rho of A(a) B(1/2) A(1 - 2a) B(1/2) A(a) at x = z^2. With the step's matrix [[A, B], [C, A]] in (q, p)
/// scaled such that H = (q^2 + p^2)/2,
///   rho = (B + C)^2 / (2 (1 - A^2)),
/// and after n steps from the canonical law the energy errs by sin^2(n t) rho kT on average, cos t = A
/// [blanes_casas_sanz_serna_2014]. Infinity where |A| >= 1.
inline double energy_error_on_oscillator(double a, double x) {
  const double rest = 0.5 - a;
  const double defect = 2.0 * a * a * rest * x + 4.0 * a * a - 6.0 * a + 1.0;
  const double rotation = (2.0 - a * x) * (2.0 - rest * x) * (1.0 - a * rest * x);
  if (!(rotation > 0.0)) return std::numeric_limits<double>::infinity();
  return x * x * defect * defect / (8.0 * rotation);
}

/// As a function of x rho rises from 0 to a hump, returns to 0 at `zero`, and then rises to infinity.
/// Whether, up to x, the hump is the worst.
inline bool hump_is_worst(double a, double x) {
  const double zero = -(4.0 * a * a - 6.0 * a + 1.0) / (2.0 * a * a * (0.5 - a));
  if (zero >= x) return true;
  constexpr int half_the_digits = 26;  // of the place, so that the height has them all
  const auto below = [&](double part) { return -energy_error_on_oscillator(a, part * zero); };
  const double hump = -boost::math::tools::brent_find_minima(below, 0.0, 1.0, half_the_digits).second;
  return hump > energy_error_on_oscillator(a, x);
}

/// argmin_a max_{0 < z <= highest_z} rho. While a grows from (3 - sqrt 5)/4, where there is no hump, the hump
/// grows and the end falls; the worst is least where they are equal.
inline double s_aia_coefficient(double highest_z) {
  const double x = highest_z * highest_z;
  double low = (3.0 - std::sqrt(5.0)) / 4.0;  // 4a^2 - 6a + 1 = 0: the best for z -> 0
  double high = 0.25;
  if (x >= 8.0) return high;  // for any other a, rho is infinite before z = sqrt 8
  for (double a = std::midpoint(low, high); a != low && a != high; a = std::midpoint(low, high)) {
    (hump_is_worst(a, x) ? high : low) = a;
  }
  return low;
}

}  // namespace detail

/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a) with the least energy error on oscillators of all z = h omega up to
/// highest_z: order 2, two evaluations. The coefficient is
///   a = argmin_a max_{0 < z <= highest_z} rho(z, a)
/// with rho, the expected error of energy, of [blanes_casas_sanz_serna_2014], and was proposed as AIA for
/// molecular simulation [fernandez_pendas_akhmatskaya_sanz_serna_2016] and as s-AIA for statistics
/// [nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024]. These multiply the frequency by a safety or fitting
/// factor (sqrt 2, say) against nonlinear instability. Here is none: highest_z is the system's own.
///
/// a grows from (3 - sqrt 5)/4 at highest_z = 0 over BCSS' 0.211781 at 2 to 1/4 at sqrt 8. From there to 4 it
/// stays 1/4, which is two half steps of position Verlet: all others are unstable before sqrt 8.
class s_aia2 : public palindromic<drift, kick, 5> {
 public:
  static constexpr int order = 2;
  static std::string name() { return "s_aia2"; }

  /// The best coefficient for all z up to highest_z. Throws std::invalid_argument unless 0 < highest_z < 4.
  /// Cost: some 30 microseconds; a is right to rounding.
  explicit s_aia2(double highest_z) : highest_z_(highest_z) {
    if (!(highest_z > 0.0) || !std::isfinite(highest_z)) {
      throw std::invalid_argument(
          sentence("s_aia2: z = step * highest frequency must be positive and finite, got {}", highest_z));
    }
    if (highest_z >= 4.0) {
      throw std::invalid_argument(sentence(
          "s_aia2: no method of two stages is stable up to z = step * highest frequency = {}; take a smaller "
          "step, such that z < 4",
          highest_z));
    }
    coefficient_ = detail::s_aia_coefficient(highest_z);
  }

  std::array<double, 5> coefficients() const { return palindrome<5>({coefficient_}); }
  double highest_z() const { return highest_z_; }  ///< as it was given

 private:
  double highest_z_;
  double coefficient_;
};

/// The member for a system at a step: up to z = |step| times the end of its highest frequency band (0 if it
/// has none). Throws what s_aia2 throws.
template <System S>
s_aia2 s_aia2_for(const S& system, double step) {
  require_suited<s_aia2, S>();
  static_assert(
      HasFrequencyBands<S>,
      "nysalt: s_aia2_for needs the system's highest frequency; give the system frequency_bands(), or "
      "use s_aia2(step * frequency)");
  double highest = 0.0;
  for (const auto& band : system.frequency_bands()) highest = std::max(highest, band.high);
  return s_aia2(std::abs(step) * highest);
}

}  // namespace nysalt
