// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "nysalt/detail/requirements.hpp"
#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

namespace detail {

/// rho of A(a) B(1/2) A(1 - 2a) B(1/2) A(a) at x = z^2. With the step's matrix [[A, B], [C, A]] in (q, p)
/// scaled such that H = (q^2 + p^2)/2,
///   rho = (B + C)^2 / (2 (1 - A^2)),
/// and after n steps from the canonical law the energy errs by sin^2(n t) rho kT on average, cos t = A
/// [blanes_casas_sanz_serna_2014]. Infinity where |A| >= 1.
double energy_error_on_oscillator(double a, double x);

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
  static constexpr std::string_view source = "nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024";
  static std::string name() { return "s_aia2"; }

  /// The best coefficient for all z up to highest_z. Throws std::invalid_argument unless 0 < highest_z < 4.
  /// Cost: some 30 microseconds; a is right to rounding.
  explicit s_aia2(double highest_z);

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
