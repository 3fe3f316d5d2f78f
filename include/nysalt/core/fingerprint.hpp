// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace nysalt::detail {

/// FNV-1a over the bytes of numbers, the lowest byte of each first: distinguishes systems of one size that
/// are made of many numbers.
class fingerprint {
 public:
  /// One more number.
  void add(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (int shift = 0; shift < 64; shift += 8) hash_ = (hash_ ^ ((bits >> shift) & 0xffU)) * 0x100000001b3U;
  }
  /// All numbers of a range.
  template <class Range>
  void add_all(const Range& numbers) {
    for (const double x : numbers) add(x);
  }

  /// Sixteen hexadecimal digits.
  std::string text() const {
    std::string digits(16, '0');
    std::uint64_t left = hash_;
    for (auto digit = digits.rbegin(); left != 0; ++digit, left >>= 4)
      *digit = "0123456789abcdef"[left & 0xfU];
    return digits;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;  // offset basis of FNV-1a for 64 bits; above, the prime
};

}  // namespace nysalt::detail
