// SPDX-License-Identifier: BSL-1.0
// Where a run may be cut.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "nysalt/detail/divergence.hpp"

namespace nysalt::program {

/// Steps that take some tenths of a second in all lanes: for who wants to look in now and then.
constexpr std::int64_t short_stretch(std::int64_t dimension) {
  return std::max<std::int64_t>(steps_between_checks, 20'000'000 / dimension);
}

/// A run of so many steps in stretches that end at the first multiple of 64 at or beyond each multiple of
/// `length`: there divergence is looked for anyway, so that cutting the run changes nothing in it.
class stretches {
 public:
  stretches(std::int64_t steps, std::optional<std::int64_t> length)
      : steps_(steps), length_(std::min(length.value_or(steps), steps)) {}

  std::int64_t end_after(std::int64_t step) const {
    // Step 64 k is the cut of the multiples in (64 (k - 1), 64 k].
    const std::int64_t next = (step / length_ + 1) * length_;
    const std::int64_t rest = next % steps_between_checks;
    const std::int64_t cut = rest == 0 ? next : next + (steps_between_checks - rest);
    return std::min(cut, steps_);
  }
  /// Steps of one, at most.
  std::int64_t longest() const { return std::min(length_ + steps_between_checks, steps_); }

 private:
  std::int64_t steps_;
  std::int64_t length_;
};

}  // namespace nysalt::program
