// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <compare>
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
  friend counting operator/(counting a, double b) { return after(multiplied, a.value / b); }
  friend counting operator-(counting a) { return counting(-a.value); }  // a sign costs next to nothing
  counting& operator+=(counting b) { return *this = *this + b; }
  counting& operator-=(counting b) { return *this = *this - b; }
  friend auto operator<=>(const counting&, const counting&) = default;

  // What letters other than A and B take of a coefficient; one operation each.
  friend counting sqrt(counting a) { return after(multiplied, std::sqrt(a.value)); }
  friend counting exp(counting a) { return after(multiplied, std::exp(a.value)); }
  friend counting expm1(counting a) { return after(multiplied, std::expm1(a.value)); }
  friend counting sin(counting a) { return after(multiplied, std::sin(a.value)); }
  friend counting cos(counting a) { return after(multiplied, std::cos(a.value)); }
};

}  // namespace nysalt::bench
