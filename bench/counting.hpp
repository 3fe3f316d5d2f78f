// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstdint>

namespace nysalt::bench {

/// A double that counts what is done with it.
struct counting {
  double value = 0.0;
  static inline std::int64_t multiplied = 0;
  static inline std::int64_t added = 0;

  counting() = default;
  explicit counting(double x) : value(x) {}
  static counting after(std::int64_t& count, double result) {
    ++count;
    return counting(result);
  }

  friend counting operator+(counting a, counting b) { return after(added, a.value + b.value); }
  friend counting operator-(counting a, counting b) { return after(added, a.value - b.value); }
  friend counting operator-(counting a, double b) { return after(added, a.value - b); }
  friend counting operator*(counting a, counting b) { return after(multiplied, a.value * b.value); }
  friend counting operator*(counting a, double b) { return after(multiplied, a.value * b); }
  friend counting operator*(double a, counting b) { return after(multiplied, a * b.value); }
  friend counting operator/(counting a, counting b) { return after(multiplied, a.value / b.value); }
  friend counting operator-(counting a) { return counting(-a.value); }  // a sign costs next to nothing
  counting& operator+=(counting b) { return *this = *this + b; }
  counting& operator-=(counting b) { return *this = *this - b; }
};

}  // namespace nysalt::bench
