// SPDX-License-Identifier: BSL-1.0
// Numbers as a person reads them.
#pragma once

#include <string>

#include <fmt/format.h>

#include "least_squares.hpp"

namespace nysalt::bench {

inline std::string duration(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (seconds < 600.0) return fmt::format("{:.3g} s", seconds);
  if (seconds < 3.6e5) return fmt::format("{:.3g} h", seconds / 3600.0);
  return fmt::format("{:.3g} days", seconds / 86400.0);
}

inline std::string amount(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.3g} B", bytes);
  if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes * 1e-3);
  if (bytes < 1e9) return fmt::format("{:.3g} MB", bytes * 1e-6);
  if (bytes < 1e12) return fmt::format("{:.3g} GB", bytes * 1e-9);
  return fmt::format("{:.3g} TB", bytes * 1e-12);
}

inline std::string with_error(const cost& fitted_cost, double unit) {
  if (fitted_cost.value == 0.0) return "too small to fit";
  const double error = fitted_cost.standard_error / unit;
  const auto digits = error >= 10.0 ? fmt::format("{:.0f}", error) : fmt::format("{:.2g}", error);
  return fmt::format("{:.4g} +- {}", fitted_cost.value / unit, digits);
}

}  // namespace nysalt::bench
