// SPDX-License-Identifier: BSL-1.0

#include "nysalt/scalars/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace nysalt {

int detail::bernstein_polynomial::turns(double rounding) const {
  int result = 0;
  double before = 0.0;
  for (std::size_t i = 0; i + 1 < c_.size(); ++i) {
    const double difference = c_[i + 1] - c_[i];
    const double size = std::max(std::abs(c_[i]), std::abs(c_[i + 1]));
    if (!(std::abs(difference) > rounding * size)) continue;
    if (before * difference < 0.0) ++result;
    before = std::copysign(1.0, difference);
  }
  return result;
}

detail::bernstein_polynomial& detail::bernstein_polynomial::operator+=(detail::bernstein_polynomial b) {
  while (c_.size() < b.c_.size()) elevate();
  while (b.c_.size() < c_.size()) b.elevate();
  for (std::size_t i = 0; i < c_.size(); ++i) c_[i] += b.c_[i];
  return *this;
}

std::pair<detail::bernstein_polynomial, detail::bernstein_polynomial> detail::bernstein_polynomial::halves()
    const {
  auto lower = *this;
  auto upper = *this;
  lower.high_ = upper.low_ = std::midpoint(low_, high_);
  for (std::size_t k = 0; k < c_.size(); ++k) {
    lower.c_[k] = upper.c_[0];
    for (std::size_t i = 0; i + k + 1 < c_.size(); ++i)
      upper.c_[i] = std::midpoint(upper.c_[i], upper.c_[i + 1]);
  }
  return {lower, upper};
}

detail::bernstein_polynomial detail::bernstein_polynomial::times_linear(double a, double b) const {
  auto result = *this;
  result.c_.push_back(0.0);
  const auto n = static_cast<double>(c_.size());
  for (std::size_t i = 0; i <= c_.size(); ++i) {
    const double part = static_cast<double>(i) / n;
    result.c_[i] = (i < c_.size() ? (1.0 - part) * a * c_[i] : 0.0) + (i > 0 ? part * b * c_[i - 1] : 0.0);
  }
  return result;
}

std::optional<double> detail::where_larger(const detail::bernstein_polynomial& f, double bound,
                                           int halvings) {
  const auto is_within = [&](double value) { return -bound <= value && value <= bound; };
  if (!is_within(f.at_low())) return f.low();
  if (!is_within(f.at_high())) return f.high();
  const auto [least, most] = f.bounds();
  if ((is_within(least) && is_within(most)) || halvings == 0) return std::nullopt;
  const auto [lower, upper] = f.halves();
  if (const auto x = detail::where_larger(lower, bound, halvings - 1)) return x;
  return detail::where_larger(upper, bound, halvings - 1);
}

}  // namespace nysalt
