// SPDX-License-Identifier: BSL-1.0
// The floating-point environment of a thread, which functions of users may change.
#pragma once

#include <cfenv>

namespace nysalt::detail {

/// While the object lives, this thread rounds to nearest and keeps subnormal numbers, so that the same
/// operations have the same bits on every thread. Its end brings back what was there before. Cost: some tens
/// of nanoseconds.
class usual_rounding {
 public:
  usual_rounding();
  ~usual_rounding();
  usual_rounding(const usual_rounding&) = delete;
  usual_rounding& operator=(const usual_rounding&) = delete;

  /// Throws std::invalid_argument where a function that was called meanwhile has changed that.
  void require() const;

 private:
  std::fenv_t before_{};
  bool was_usual_;
};

}  // namespace nysalt::detail
