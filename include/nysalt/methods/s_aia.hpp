// SPDX-License-Identifier: BSL-1.0
// Two and three stages whose coefficients suit the highest frequency of a system.
#pragma once

#include <string_view>

#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

namespace detail {

/// rho, see energy_error_on_oscillator(), of A(a) B(1/2) A(1 - 2a) B(1/2) A(a) at x = z^2, in closed form.
/// Infinite where that is not stable.
double energy_error_of_two_stages(double a, double x);

/// rho of B(b) A(a) B(1/2 - b) A(1 - 2a) B(1/2 - b) A(a) B(b) at x = z^2, in closed form, with the a of
/// s_aia3.
double energy_error_of_three_stages(double b, double x);

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
class s_aia2 : public method {
 public:
  static constexpr std::string_view source = "nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024";
  static constexpr word letters_of_all{"ABABA"};                ///< letters at every z
  static constexpr method_properties promises{2, true, false};  ///< properties at every z

  /// The best coefficient for all z up to highest_z. Throws std::invalid_argument unless 0 < highest_z < 4.
  /// Cost: some 30 microseconds; a is right to rounding.
  explicit s_aia2(double highest_z);
  double highest_z() const { return highest_z_; }  ///< largest z, as given

 private:
  double highest_z_;
};

/// B(b) A(a) B(1/2 - b) A(1 - 2a) B(1/2 - b) A(a) B(b) with the least energy error on oscillators of all z up
/// to highest_z, among those with 6 a b - 2 a - b + 1/2 = 0: order 2, three evaluations. On that curve two
/// ends of stability windows meet, so that the word is stable beyond them
/// [blanes_casas_sanz_serna_2014]; b is found along it as the a of s_aia2
/// [nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024].
///
/// b grows from the b of predescu3 at highest_z = 0 over BCSS' 0.11888 at 3 to 1/6 at sqrt 27. From there to
/// 6 it stays 1/6, which is three equal steps of velocity Verlet: all others are unstable before sqrt 27.
class s_aia3 : public method {
 public:
  static constexpr std::string_view source = "nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024";
  static constexpr word letters_of_all{"BABABAB"};              ///< letters at every z
  static constexpr method_properties promises{2, true, false};  ///< properties at every z

  /// The best coefficients for all z up to highest_z. Throws std::invalid_argument unless 0 < highest_z < 6.
  /// Cost: some 30 microseconds; b is right to rounding.
  explicit s_aia3(double highest_z);
  double highest_z() const { return highest_z_; }  ///< largest z, as given

 private:
  double highest_z_;
};

/// The member for a system at a step: up to z = |step| times the end of its highest frequency band (0 if it
/// has none). Throws what s_aia2 throws.
s_aia2 s_aia2_for(const model& system, double step);

}  // namespace nysalt
