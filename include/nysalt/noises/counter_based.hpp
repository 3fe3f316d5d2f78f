// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace nysalt {

/// What a random number is for, so that no two uses share one.
enum class noise_purpose : std::uint32_t { initial_state = 1 };

/// Two independent standard normal numbers, a pure function of the arguments: Philox 4x32-10 with the seed
/// as its key [salmon_2011], then Box and Muller on two 53-bit uniforms. No state, hence no order.
inline std::array<double, 2> standard_normals(std::uint64_t seed, std::uint64_t trajectory,
                                              std::uint32_t slot, noise_purpose purpose) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
  const r123::Philox4x32::key_type key = {{low(seed), high(seed)}};
  const r123::Philox4x32::ctr_type counter = {
      {low(trajectory), high(trajectory), slot, static_cast<std::uint32_t>(purpose)}};
  const auto word = r123::Philox4x32()(counter, key);
  const auto uniform = [](std::uint32_t a, std::uint32_t b) {  // in (0, 1): the half keeps log finite
    const std::uint64_t bits = ((std::uint64_t{a} << 32U) | b) >> 11U;
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
  };
  const double radius = std::sqrt(-2.0 * std::log(uniform(word[0], word[1])));
  const double angle = 2.0 * std::numbers::pi * uniform(word[2], word[3]);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace nysalt
