// SPDX-License-Identifier: BSL-1.0
// Sums of forces whose bits do not depend on the order of the summands.
#pragma once

#include <algorithm>
#include <cstdint>

#include "nysalt/scalars/pack.hpp"

namespace nysalt::detail {

/// Pairs of atoms at a time. No result depends on it.
inline constexpr int pairs_at_a_time = std::min(native_lanes, 4);
using reals = native_vector<pairs_at_a_time>::type;
using integers = native_vector<pairs_at_a_time>::mask;

constexpr reals all_lanes(double x) { return x - reals{}; }

/// A sum of doubles in two bins with fixed exponents [demmel_nguyen_2013]: each summand is cut into a
/// multiple of 2^-19 and a rest, which is rounded to a multiple of 2^-60; both bins add without rounding, so
/// that any order of the summands, over any lanes, gives the same bits. The sum is that of the summands to
/// 2^-64 for each of them, rounded once. Holds while the summands of a lane are fewer than 256 and their
/// magnitudes sum to less than 2^32.
///
/// A summand halfway between two multiples of 2^-19 goes to either with the rest that belongs to it, and the
/// sum is the same. A rest halfway between two multiples of 2^-60 would be rounded as the bin happens to be
/// even or odd: the last bit of the rest, at most 2^-73, is set, so that no rest is.
class exact_sum {
  static constexpr double upper_start = 0x1.8p33;  // numbers from 2^33 to 2^34 are multiples of 2^-19
  static constexpr double lower_start = 0x1.8p-8;  // numbers from 2^-8 to 2^-7 of 2^-60

 public:
  [[gnu::always_inline]] void add(const reals& summand) {
    const reals sum = upper_ + summand;
    const reals rest = summand - (sum - upper_);
    upper_ = sum;
    lower_ += reinterpret_cast<reals>(reinterpret_cast<integers>(rest) | 1);
  }
  double total() const {
    double upper = 0.0;
    double lower = 0.0;
    for (int k = 0; k < pairs_at_a_time; ++k) {
      upper += upper_[k] - upper_start;
      lower += lower_[k] - lower_start;
    }
    return upper + lower;
  }

 private:
  reals upper_ = all_lanes(upper_start);
  reals lower_ = all_lanes(lower_start);
};

}  // namespace nysalt::detail
