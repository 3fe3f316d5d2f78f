// SPDX-License-Identifier: BSL-1.0
// Positions in a periodic cube as integers, whose differences are those of the nearest images.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "exact_sum.hpp"

namespace nysalt::detail {

inline constexpr int places_bits = 52;  // those of the fraction of a double
inline constexpr std::int64_t bits_of_position = (std::int64_t{1} << places_bits) - 1;
inline constexpr std::int64_t half_a_box = std::int64_t{1} << (places_bits - 1);

/// A position in units of 2^-52 of the side of the box, modulo 2^52; what is above these bits is of no
/// meaning. Differences are exact, and that of two atoms is minus that of the two in the other order.
struct alignas(32) place {
  std::array<std::int64_t, 3> axis{};
  std::int64_t unused = 0;
};

/// Of coordinate x, in units of the side, rounded once. |x| < 2^51.
inline std::int64_t place_of(double x) {
  constexpr double integer = 0x1.8p52;  // numbers from 2^52 to 2^53 are integers
  const double fraction = x - ((x + integer) - integer);
  return std::bit_cast<std::int64_t>(fraction + 1.5);  // numbers from 1 to 2 are multiples of 2^-52
}

/// From 0 to below 1.
inline double fraction_of(std::int64_t place) {
  return static_cast<double>(place & bits_of_position) * 0x1p-52;
}

/// The way to one place from others, by the nearest image, in units of the side.
struct ways {
  reals x;
  reals y;
  reals z;
  reals square;  ///< of the distance
};

/// An atom, in all lanes, moved by half a box.
struct centre {
  explicit centre(const place& at)
      : x(integers{} + (at.axis[0] + half_a_box)),
        y(integers{} + (at.axis[1] + half_a_box)),
        z(integers{} + (at.axis[2] + half_a_box)) {}
  integers x;
  integers y;
  integers z;
};

[[gnu::always_inline]] inline reals way(const integers& to_moved, const integers& from) {
  constexpr std::int64_t exponent_of_one = std::int64_t{1023} << places_bits;
  return reinterpret_cast<reals>(((to_moved - from) & bits_of_position) | exponent_of_one) - 1.5;
}

/// Three numbers of each atom, which is followed by one that is not used, with an axis in each register.
template <class V>
struct axes {
  V x;
  V y;
  V z;
};

/// number(k) is where those of lane k begin.
template <class V>
[[gnu::always_inline]] inline axes<V> transposed(const auto& number) {
  const auto load = [&](int k, int first) __attribute__((always_inline)) {
    V result;
    __builtin_memcpy(&result, number(k) + first, sizeof result);
    return result;
  };
  if constexpr (pairs_at_a_time == 4) {
    const V a = load(0, 0);
    const V b = load(1, 0);
    const V c = load(2, 0);
    const V d = load(3, 0);
    const V xz_left = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const V xz_right = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const V y_left = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const V y_right = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(xz_left, xz_right, 0, 1, 4, 5),
            __builtin_shufflevector(y_left, y_right, 0, 1, 4, 5),
            __builtin_shufflevector(xz_left, xz_right, 2, 3, 6, 7)};
  } else {
    const V a = load(0, 0);
    const V b = load(1, 0);
    return {__builtin_shufflevector(a, b, 0, 2), __builtin_shufflevector(a, b, 1, 3),
            __builtin_shufflevector(load(0, 2), load(1, 2), 0, 2)};
  }
}

/// From the atoms place(k) of the lanes to the centre.
[[gnu::always_inline]] inline ways ways_to(const centre& to, const auto& place) {
  const auto from =
      transposed<integers>([&](int k) __attribute__((always_inline)) { return place(k).axis.data(); });
  ways result{way(to.x, from.x), way(to.y, from.y), way(to.z, from.z), {}};
  result.square = result.x * result.x + result.y * result.y + result.z * result.z;
  return result;
}

}  // namespace nysalt::detail
