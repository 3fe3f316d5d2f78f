// SPDX-License-Identifier: BSL-1.0
// Seeds of stochastic tests: `./dev check seeds` runs these tests at many seeds, and measures how often they
// fail.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace nysalt::test {

/// The seed n of a test, shifted by NYSALT_TEST_SEED_SHIFT, 0 if that is not set. No test has a million
/// seeds, so that those of two shifts differ.
inline std::uint64_t seed(std::uint64_t n) {
  static const std::uint64_t shift = [] {
    const char* text = std::getenv("NYSALT_TEST_SEED_SHIFT");
    return text == nullptr ? 0U : std::stoull(text);
  }();
  return n + 1'000'003 * shift;
}

}  // namespace nysalt::test
