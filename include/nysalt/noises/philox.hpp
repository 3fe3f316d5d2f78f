// SPDX-License-Identifier: BSL-1.0
// Random bits as a function of a counter and a key.
#pragma once

#include <array>
#include <cstdint>

#include "nysalt/noises/words.hpp"

namespace nysalt::detail {

/// Philox 4x32-10 [salmon_2011] in every lane: ten rounds of two products each; the multipliers and the
/// increments of the key are those of its authors' library Random123. The counter's four words of 32 bits
/// lie in lower halves; upper halves, the key's too, hold what they like and are of no account. If w are the
/// four words that come out, the result is {w[0] 2^32 + w[1], w[2] 2^32 + w[3]}.
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

}  // namespace nysalt::detail
