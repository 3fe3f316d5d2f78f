// SPDX-License-Identifier: BSL-1.0
// Counter-based noise: a function of a seed, a trajectory, a step and a letter, by the bits of Philox.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/noise.hpp"
#include "nysalt/phase_point.hpp"
#include "nysalt/scalars/pack.hpp"

// 64 bits beside each lane of a pack.

namespace nysalt::detail {

/// Unsigned integers in lanes, with what random bits need; + wraps. There are as many lanes as in
/// pack<double>, for normals of any scalar: two registers, which hide each other's latency.
class words {
 public:
  using doubles = pack<double>;
  static constexpr int lanes = doubles::lanes;
  static constexpr int of_part = doubles::of_part;
  typedef std::uint64_t part __attribute__((vector_size(8 * of_part)));

  words() = default;
  words(std::uint64_t all) {
    for (part& mine : parts) mine = part{} + all;
  }

  /// 0, 1, 2, ...: a constant to the compiler, which numbers set one by one are not.
  static words lane_numbers() {
    constexpr auto numbers = [] {
      std::array<std::uint64_t, lanes> result{};
      for (std::size_t lane = 0; lane < lanes; ++lane) result[lane] = lane;
      return result;
    }();
    return std::bit_cast<words>(numbers);
  }

  std::uint64_t operator[](int lane) const {
    return parts[static_cast<std::size_t>(lane / of_part)][lane % of_part];
  }
  void set(int lane, std::uint64_t value) {
    parts[static_cast<std::size_t>(lane / of_part)][lane % of_part] = value;
  }

  friend words operator+(const words& a, const words& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x + y; });
  }
  friend words operator&(const words& a, const words& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x & y; });
  }
  friend words operator|(const words& a, const words& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x | y; });
  }
  friend words operator^(const words& a, const words& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return x ^ y; });
  }
  friend words operator<<(const words& a, int n) {
    return each(
        a, a, [n](part x, part) __attribute__((always_inline)) { return x << n; });
  }
  friend words operator>>(const words& a, int n) {
    return each(
        a, a, [n](part x, part) __attribute__((always_inline)) { return x >> n; });
  }
  /// The products of the lower halves: 32 by 32 bits, 64 bits long.
  friend words product_of_lower_halves(const words& a, const words& b) {
    return each(
        a, b, [](part x, part y) __attribute__((always_inline)) { return product(x, y); });
  }

  /// The bits of a double, and back.
  static words of(const doubles& x) {
    words result;
    for (std::size_t i = 0; i < x.parts.size(); ++i) result.parts[i] = reinterpret_cast<part>(x.parts[i]);
    return result;
  }
  doubles as_doubles() const {
    doubles result;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      result.parts[i] = reinterpret_cast<doubles::part>(parts[i]);
    }
    return result;
  }

  lane_mask<lanes> not_zero() const {
    lane_mask<lanes> result;
    for (std::size_t i = 0; i < parts.size(); ++i) result.parts[i] = parts[i] != 0;
    return result;
  }

  std::array<part, lanes / of_part> parts;

 private:
  [[gnu::always_inline]] static words each(const words& a, const words& b, auto f) {
    words result;
    for (std::size_t i = 0; i < a.parts.size(); ++i) result.parts[i] = f(a.parts[i], b.parts[i]);
    return result;
  }

  /// g++ knows the instruction only by name: of the formula below it makes a product of 64 by 64 bits, which
  /// costs three times as much.
  [[gnu::always_inline]] static part product(part x, part y) {
#if defined __AVX512F__
    return reinterpret_cast<part>(
        _mm512_maskz_mul_epu32(0xff, reinterpret_cast<__m512i>(x), reinterpret_cast<__m512i>(y)));
#elif defined __AVX2__
    return reinterpret_cast<part>(
        _mm256_mul_epu32(reinterpret_cast<__m256i>(x), reinterpret_cast<__m256i>(y)));
#elif defined __SSE2__ && !defined __AVX__
    return reinterpret_cast<part>(_mm_mul_epu32(reinterpret_cast<__m128i>(x), reinterpret_cast<__m128i>(y)));
#else
    return (x & 0xffffffffU) * (y & 0xffffffffU);
#endif
  }
};

// Random bits as a function of a counter and a key.

/// Philox 4x32-10 [salmon_2011] in every lane: ten rounds of two products each; the multipliers and the
/// increments of the key are the same as in its authors' library Random123. The counter's four words of 32
/// bits lie in lower halves; upper halves, the key's too, hold what they like and are of no account. If w are
/// the four words that come out, the result is {w[0] 2^32 + w[1], w[2] 2^32 + w[3]}.
[[gnu::always_inline]] inline std::array<words, 2> philox(std::array<words, 4> counter, std::uint64_t key) {
  constexpr int rounds = 10;
  std::uint64_t first_key = key;
  std::uint64_t second_key = key >> 32U;
  for (int round = 1; round < rounds; ++round) {
    const words first = product_of_lower_halves(counter[0], 0xD2511F53U);
    const words second = product_of_lower_halves(counter[2], 0xCD9E8D57U);
    counter = {(second >> 32) ^ counter[1] ^ first_key, second, (first >> 32) ^ counter[3] ^ second_key,
               first};
    first_key += 0x9E3779B9U;
    second_key += 0xBB67AE85U;
  }
  // In the last round upper and lower half of a product already lie as the result wants them.
  const words first = product_of_lower_halves(counter[0], 0xD2511F53U);
  const words second = product_of_lower_halves(counter[2], 0xCD9E8D57U);
  return {second ^ ((counter[1] ^ first_key) << 32), first ^ ((counter[3] ^ second_key) << 32)};
}

// From random bits to normal numbers: two independent uniform numbers u and v in (0, 1) give
// sqrt(-2 log u) cos(2 pi v) and sqrt(-2 log u) sin(2 pi v) [box_muller_1958]. Only + - * / sqrt and
// operations on bits, so that every lane, compiler and processor gives the same numbers.

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

/// The pair: the upper 51 bits choose a direction of the quarter around the direction of x, symmetric and
/// never its middle; the lowest bit turns the pair by half a turn, the next one reflects it in the diagonal.
[[gnu::always_inline]] inline std::array<pack<double>, 2> normal_pair(const pack<double>& squared_distance,
                                                                      const words& bits) {
  const pack<double> one_to_two = ((bits >> 12) | (bits_of_one + 1)).as_doubles();
  const auto [sine, cosine] = sine_and_cosine_of_quarter_turns(one_to_two - 1.5);
  const pack<double> r = (words::of(sqrt(squared_distance)) ^ (bits << 63)).as_doubles();
  const auto reflected = (bits & 2).not_zero();
  return {r * select(reflected, sine, cosine), r * select(reflected, cosine, sine)};
}

}  // namespace nysalt::detail

// Normal numbers without a state: each is a function of where it is used.

namespace nysalt {

/// The purpose of a random number, so that no two uses share one.
enum class noise_purpose : std::uint8_t {
  initial_state = 1,   ///< initial state of a trajectory
  bath = 2,            ///< noise of the bath in a run
  bath_halves = 3,     ///< noise that splits a letter O into halves
  finer_path = 4,      ///< noise that splits a step of a path into halves
  burn_in = 5,         ///< noise of the run that makes an initial state
  burn_in_halves = 6,  ///< noise that splits letters O of that run
  search = 7,          ///< random starts of a search
  perturbation = 8,    ///< perturbation of a start
  momenta = 9,         ///< momenta of a trajectory of Hybrid Monte Carlo, and whether it is accepted
  duration = 10        ///< durations of trajectories of Hybrid Monte Carlo
};

/// Index of random numbers. A slot holds two of them: a step that needs N numbers k times gives
/// slots_for(N) slots to each time.
struct noise_counter {
  std::uint64_t trajectory = 0;  ///< below 2^48
  std::int64_t step = 0;         ///< step number, 0 <= step < 2^48
  std::uint64_t slot = 0;        ///< below 2^24
  noise_purpose purpose{};       ///< purpose of the numbers
};

namespace detail {

/// The number of slots that hold n numbers.
constexpr std::uint64_t slots_for(std::uint64_t numbers) { return numbers / 2 + numbers % 2; }

/// Throws std::invalid_argument if a trajectory, the step or a slot does not fit into the counter.
inline void check_counter(const noise_counter& first, std::uint64_t trajectories, std::uint64_t slots) {
  constexpr std::uint64_t two_to_48 = std::uint64_t{1} << 48U;
  constexpr std::uint64_t two_to_24 = std::uint64_t{1} << 24U;
  if (first.trajectory > two_to_48 - trajectories) {
    throw std::invalid_argument(
        sentence("standard_normals: trajectory must be < 2^48, got {}", first.trajectory));
  }
  if (first.step < 0 || first.step >= static_cast<std::int64_t>(two_to_48)) {
    throw std::invalid_argument(
        sentence("standard_normals: step must be >= 0 and < 2^48, got {}", first.step));
  }
  if (slots > two_to_24 || first.slot > two_to_24 - slots) {
    throw std::invalid_argument(
        sentence("standard_normals: slots of a step must be < 2^24, got {} slots from slot {}; use "
                 "fewer numbers a step",
                 slots, first.slot));
  }
}

/// Count lanes from the first on of one pack become lanes of another, or a double, which has one lane.
template <class T>
[[gnu::always_inline]] inline void copy_lanes(const pack<double>& from, int first, int count, T& to,
                                              int to_first) {
  constexpr int of_part = pack<double>::of_part;
  const int end = std::min(count, lanes_in<T> - to_first);
  if constexpr (lanes_in<T> % of_part == 0) {  // whole registers
    for (int k = 0; k < end; k += of_part) {
      to.parts[static_cast<std::size_t>((to_first + k) / of_part)] =
          from.parts[static_cast<std::size_t>((first + k) / of_part)];
    }
  } else {
    for (int k = 0; k < end; ++k) set_lane(to, to_first + k, from[first + k]);
  }
}

/// The pairs of some slots, each with one trajectory in each lane, become the numbers from the first
/// on.
template <int Trajectories, class T>
[[gnu::always_inline]] inline void copy_pairs(const std::array<pack<double>, 2>& pairs, std::span<T> out,
                                              std::size_t first, int lane) {
  for (int k = 0; k < words::lanes; k += Trajectories) {
    for (const auto& numbers : pairs) {
      if (first < out.size()) copy_lanes(numbers, k, Trajectories, out[first], lane);
      ++first;
    }
  }
}

/// Numbers of one trajectory, or of several in lanes.
template <class T>
concept DoubleOrPack = std::same_as<T, double> || is_pack<T>;

}  // namespace detail

/// Independent standard normal numbers, a pure function of seed and counter, independent of T, of the number
/// of numbers and of the order of calls: Philox 4x32-10 with the seed as its key [salmon_2011], then Box and
/// Muller's formula on uniform numbers of 52 bits. out[i] is number i % 2 of slot first.slot + i/2; lane l of
/// a pack belongs to trajectory first.trajectory + l. The counter's words of 32 bits are
///   trajectory mod 2^32,  trajectory div 2^32 + 2^16 (step div 2^32),  step mod 2^32,  slot + 2^24 purpose.
/// T is double or pack<double, W>. Least cost a number: pack<double>, or double if there are many. Throws
/// std::invalid_argument if trajectory, step or slot are out of range.
template <detail::DoubleOrPack T>
[[gnu::noinline]] void standard_normals(std::uint64_t seed, const noise_counter& first, std::span<T> out) {
  using detail::words;
  constexpr int lanes = lanes_in<T>;
  // All lanes of words are filled: with trajectories, and with several slots if these are few.
  constexpr int trajectories = std::min(static_cast<int>(std::bit_ceil(unsigned{lanes})), words::lanes);
  constexpr int slots = words::lanes / trajectories;
  constexpr std::size_t most = 8;  // registers at a time: more than the processor reorders
  const std::uint64_t needed = detail::slots_for(out.size());
  detail::check_counter(first, lanes, needed);

  const auto step = static_cast<std::uint64_t>(first.step);
  const std::uint64_t purpose = std::uint64_t{static_cast<std::uint8_t>(first.purpose)} << 24U;
  const words number = words::lane_numbers();
  for (int lane = 0; lane < lanes; lane += trajectories) {
    const words trajectory =
        (number & (trajectories - 1)) + (first.trajectory + static_cast<std::uint64_t>(lane));
    const words slot = (number >> std::countr_zero(unsigned{trajectories})) + first.slot;
    const words upper = (trajectory >> 32) | ((step >> 32U) << 16U);
    for (std::uint64_t done = 0; done < needed; done += most * slots) {
      const std::size_t count = std::min<std::size_t>(most, (needed - done + slots - 1) / slots);
      std::array<std::array<words, 2>, most> bits;
      std::array<pack<double>, most> squared_distance;
      for (std::size_t i = 0; i < count; ++i) {
        bits[i] = detail::philox({trajectory, upper, step, (slot + (done + i * slots)) | purpose}, seed);
      }
      for (std::size_t i = 0; i < count; ++i) squared_distance[i] = detail::squared_distance(bits[i][0]);
      for (std::size_t i = 0; i < count; ++i) {
        detail::copy_pairs<trajectories>(detail::normal_pair(squared_distance[i], bits[i][1]), out,
                                         2 * (done + i * slots), lane);
      }
    }
  }
}

/// Writes standard normals into a vector.
template <class T, int N>
void standard_normals(std::uint64_t seed, const noise_counter& first, vector<T, N>& out) {
  standard_normals<T>(seed, first, std::span<T>(out.data(), static_cast<std::size_t>(out.size())));
}

namespace detail {

/// The uniform number between 0 and 1 that is as likely not exceeded as a standard normal one.
inline double uniform_by_normal(double normal) { return 0.5 * std::erfc(-normal / std::numbers::sqrt2); }
/// One of the numbers below `count`, each as likely, by a standard normal one.
inline std::size_t index_by_normal(double normal, std::size_t count) {
  const double place = uniform_by_normal(normal) * static_cast<double>(count);
  return std::min(static_cast<std::size_t>(place), count - 1);
}
/// The uniform number between 0 and 1 of the upper 53 of 64 random bits: distributions of the standard differ
/// between libraries, bits of the same engine do not.
inline double uniform_by_bits(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

}  // namespace detail

/// Fresh noise: a pure function of seed, trajectory, step and letter. Two runs with one seed see the same
/// numbers at the same places, for any lanes, threads and order.
class counter_noise {
 public:
  static constexpr bool is_memoryless = true;

  /// `purpose` keeps it apart from all other noise of the same seed.
  explicit counter_noise(std::uint64_t seed, noise_purpose purpose = noise_purpose::bath)
      : seed_(seed), purpose_(purpose) {}

  /// The standard normal numbers of a place. Throws std::invalid_argument if the place is beyond what can be
  /// counted (2^48 trajectories and steps).
  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    draw(purpose_, at, xi);
  }
  /// Further numbers of a place, independent of the first. Throws as normals does.
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    const bool is_burn_in = purpose_ == noise_purpose::burn_in;
    draw(is_burn_in ? noise_purpose::burn_in_halves : noise_purpose::bath_halves, at, zeta);
  }

 private:
  template <class T, int N>
  void draw(noise_purpose purpose, const noise_place& at, vector<T, N>& out) const {
    const auto slots = detail::slots_for(static_cast<std::uint64_t>(out.size()));
    const noise_counter counter{.trajectory = at.trajectory,
                                .step = at.step,
                                .slot = slots * static_cast<std::uint64_t>(at.flow),
                                .purpose = purpose};
    standard_normals(seed_, counter, out);
  }

  std::uint64_t seed_;
  noise_purpose purpose_;
};

/// Fresh noise of some step, for that step halved k times: the same path, seen more finely. With
/// a = e^{-gamma h} of the half step h, and zeta further numbers, the halves of xi are
///   xi_1 = (a xi + zeta)/sqrt(1 + a^2),  xi_2 = (xi - a zeta)/sqrt(1 + a^2).
/// Of words with one letter O.
class finer_noise {
 public:
  static constexpr bool is_memoryless = false;

  /// Noise of that seed for steps that were halved so often. `damping` is gamma times the step that is not
  /// halved.
  finer_noise(std::uint64_t seed, double damping, int halvings)
      : whole_(seed), halves_(seed, noise_purpose::finer_path), damping_(damping), halvings_(halvings) {}

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    halved(halvings_, at, xi);
  }

 private:
  template <class T, int N>
  void halved(int times, const noise_place& at, vector<T, N>& xi) const {
    if (times == 0) return whole_.normals(at, xi);
    const noise_place parent{at.trajectory, at.step / 2, 0};
    auto zeta = xi;
    halved(times - 1, parent, xi);
    halves_.normals(noise_place{at.trajectory, at.step / 2, times}, zeta);
    const double a = std::exp(-std::ldexp(damping_, -times));
    const double scale = 1.0 / std::sqrt(1.0 + a * a);
    const bool is_first = at.step % 2 == 0;
    const double of_xi = (is_first ? a : 1.0) * scale;
    const double of_zeta = (is_first ? 1.0 : -a) * scale;
    for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = xi[i] * of_xi + zeta[i] * of_zeta;
  }

  counter_noise whole_;
  counter_noise halves_;
  double damping_;
  int halvings_;
};

}  // namespace nysalt
