// SPDX-License-Identifier: BSL-1.0
// 64 bits beside each lane of a pack.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "nysalt/scalars/pack.hpp"

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

}  // namespace nysalt::detail
