// SPDX-License-Identifier: BSL-1.0
#include "nysalt/core/rounding.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "nysalt/core/sentence.hpp"

namespace nysalt::detail {

namespace {

/// Neither results below the least normal number (FTZ) nor operands there (DAZ) are taken for 0.
bool keeps_subnormals() {
  const volatile double least_normal = std::numeric_limits<double>::min();
  const volatile double least = std::numeric_limits<double>::denorm_min();
  return least_normal * 0.5 != 0.0 && least != 0.0;
}

bool is_usual() { return std::fegetround() == FE_TONEAREST && keeps_subnormals(); }

std::string rounding_now() {
  switch (std::fegetround()) {
    case FE_TONEAREST:
      return "subnormal numbers that are 0";
    case FE_UPWARD:
      return "rounding upward";
    case FE_DOWNWARD:
      return "rounding downward";
    case FE_TOWARDZERO:
      return "rounding toward zero";
    default:
      return "another rounding";
  }
}

}  // namespace

usual_rounding::usual_rounding() : was_usual_(is_usual()) {
  std::fegetenv(&before_);
  if (!was_usual_) std::fesetenv(FE_DFL_ENV);
}

usual_rounding::~usual_rounding() {
  if (!was_usual_ || !is_usual()) std::fesetenv(&before_);
}

void usual_rounding::require() const {
  if (is_usual()) return;
  throw std::invalid_argument(
      sentence("the functions of a system must leave the floating-point environment as it is, got {} after a "
               "call; restore it (fesetround, _mm_setcsr) before the function returns",
               rounding_now()));
}

}  // namespace nysalt::detail
