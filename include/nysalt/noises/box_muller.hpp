// SPDX-License-Identifier: BSL-1.0
// From random bits to normal numbers: two independent uniform numbers u and v in (0, 1) give
// sqrt(-2 log u) cos(2 pi v) and sqrt(-2 log u) sin(2 pi v) [box_muller_1958]. Only + - * / sqrt and
// operations on bits, so that every lane, compiler and processor gives the same numbers.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>

#include "nysalt/noises/words.hpp"

namespace nysalt::detail {

// How a double is stored (IEEE 754): sign, 11 bits of exponent + 1023, 52 bits of fraction.
inline constexpr int fraction_bits = 52;
inline constexpr std::uint64_t bits_of_one = std::uint64_t{1023} << fraction_bits;

/// a[0] + a[1] z + ... + a[6] z^6 in Estrin's order: first the pairs, which do not wait for each other.
[[gnu::always_inline]] inline pack<double> polynomial(const std::array<double, 7>& a, const pack<double>& z) {
  const pack<double> z2 = z * z;
  const pack<double> z4 = z2 * z2;
  return ((a[0] + a[1] * z) + (a[2] + a[3] * z) * z2) + ((a[4] + a[5] * z) + a[6] * z2) * z4;
}

/// -2 log x of a normal positive number: x = 2^k m with m from sqrt(1/2) to sqrt(2) gives
/// log x = k log 2 + 2 artanh s, s = (m - 1)/(m + 1). Relative error below 8 units of 2^-53, for x in (0, 1).
[[gnu::always_inline]] inline pack<double> minus_two_log(const pack<double>& x) {
  // -4 artanh(s)/s over s^2: least greatest relative error, 2e-16, by Remez' algorithm in 50 digits.
  constexpr std::array a = {-4.000000000000001,  -1.3333333333310446,  -0.800000001240326,
                            -0.5714283196225276, -0.44446874348886345, -0.3624370988697896,
                            -0.33677122911137514};
  constexpr std::uint64_t root_of_half = 0x3fe6a09e667f3bcdU;  // the bits of sqrt(1/2)
  constexpr std::uint64_t bits_of_two_to_52 = std::uint64_t{1023 + 52} << fraction_bits;
  constexpr std::uint64_t fraction = (std::uint64_t{1} << fraction_bits) - 1;
  const words shifted = words::of(x) + (bits_of_one - root_of_half);  // the exponent grows where m starts
  const pack<double> k = ((shifted >> fraction_bits) | bits_of_two_to_52).as_doubles() - (0x1p52 + 1023.0);
  const pack<double> m = ((shifted & fraction) + root_of_half).as_doubles();
  const pack<double> s = (m - 1.0) / (m + 1.0);
  return k * (-2.0 * std::numbers::ln2) + s * polynomial(a, s * s);
}

struct sine_and_cosine {
  pack<double> sine;
  pack<double> cosine;
};

/// sin and cos of t quarter turns, pi t/2, for |t| <= 1/2. Relative error below 4 units of 2^-53.
[[gnu::always_inline]] inline sine_and_cosine sine_and_cosine_of_quarter_turns(const pack<double>& t) {
  // sin(pi t/2)/t and cos(pi t/2) over t^2: least greatest relative error, 5e-17 and 2e-16, found as above.
  constexpr std::array a = {1.5707963267948966,    -0.6459640975062443,    0.07969262624603957,
                            -0.004681754132282454, 0.00016044115029189453, -3.5986417551299964e-06,
                            5.633721075556274e-08};
  constexpr std::array b = {0.9999999999999999,    -1.2337005501361489,   0.25366950789975307,
                            -0.020863480733058038, 0.0009192599355754267, -2.5200084118976642e-05,
                            4.654617405948912e-07};
  const pack<double> z = t * t;
  return {t * polynomial(a, z), polynomial(b, z)};
}

/// The pair's squared distance from 0, -2 log u: the upper 52 bits choose u = (k + 1/2)/2^52, which is exact
/// and neither 0 nor 1. No pair lies farther out than 8.57; the distribution has 2^-53 there.
[[gnu::always_inline]] inline pack<double> squared_distance(const words& bits) {
  const pack<double> one_to_two = ((bits >> 12) | bits_of_one).as_doubles();
  return minus_two_log(one_to_two - (1.0 - 0x1p-53));
}

/// The pair: the upper 51 bits choose a direction of the quarter around that of x, symmetric and never its
/// middle; the lowest bit turns the pair by half a turn, the next one reflects it in the diagonal.
[[gnu::always_inline]] inline std::array<pack<double>, 2> normal_pair(const pack<double>& squared_distance,
                                                                      const words& bits) {
  const pack<double> one_to_two = ((bits >> 12) | (bits_of_one + 1)).as_doubles();
  const auto [sine, cosine] = sine_and_cosine_of_quarter_turns(one_to_two - 1.5);
  const pack<double> r = (words::of(sqrt(squared_distance)) ^ (bits << 63)).as_doubles();
  const auto reflected = (bits & 2).not_zero();
  return {r * select(reflected, sine, cosine), r * select(reflected, cosine, sine)};
}

}  // namespace nysalt::detail
