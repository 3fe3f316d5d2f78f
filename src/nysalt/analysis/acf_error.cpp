// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/acf_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace nysalt {

acf_distance acf_error(const autocovariance& a, const autocovariance& b) {
  if (a.lags() != b.lags() || std::abs(a.interval() - b.interval()) > 1e-9 * std::abs(a.interval())) {
    throw std::invalid_argument(
        fmt::format("acf_error: both autocovariances must have the same lags, got {} lags of {} and {} "
                    "lags of {}; sample both at the same times",
                    a.lags(), a.interval(), b.lags(), b.interval()));
  }
  using numbers = std::vector<double>;
  const auto over_lags = [](const numbers& at, const numbers& other, auto&& term) {
    double sum = 0.0;
    for (std::size_t k = 1; k < at.size(); ++k) sum += term(at[k], other[k]);
    return std::sqrt(sum / static_cast<double>(at.size() - 1));
  };
  const auto distance = [&](const numbers& x, const numbers& y) {
    return over_lags(x, y, [](double u, double v) { return (u - v) * (u - v); });
  };
  const numbers rho_a = a.normalised();
  const numbers rho_b = b.normalised();
  const numbers from_a = a.jackknife([&](const numbers& rho) { return numbers{distance(rho, rho_b)}; });
  const numbers from_b = b.jackknife([&](const numbers& rho) { return numbers{distance(rho, rho_a)}; });
  const double floor =
      over_lags(a.standard_error(), b.standard_error(), [](double u, double v) { return u * u + v * v; });
  return {distance(rho_a, rho_b), std::sqrt(from_a[0] + from_b[0]), floor};
}

}  // namespace nysalt
