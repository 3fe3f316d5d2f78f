// SPDX-License-Identifier: BSL-1.0
// How far one autocovariance is from another.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "nysalt/analysis/autocovariance.hpp"

namespace nysalt {

/// A distance of two autocovariances, and how well it is known.
struct acf_distance {
  double rms;             ///< root mean square difference over the lags 1..L
  double standard_error;  ///< of rms
  double floor;           ///< what rms would be about if only sampling made a difference
};

/// rms = sqrt(1/L sum_{k=1..L} (rho_a(k) - rho_b(k))^2) of the normalised autocovariances, with the standard
/// error of independent ensembles; floor^2 = 1/L sum_k (error_a(k)^2 + error_b(k)^2), the mean of rms^2 if
/// both have one law. If a and b share starts or noise, error and floor are larger than needed. Throws
/// std::invalid_argument if lags or intervals (to 1e-9 relative, as steps are typed in decimals) differ, and
/// like autocovariance::normalised.
inline acf_distance acf_error(const autocovariance& a, const autocovariance& b) {
  if (a.lags() != b.lags() || std::abs(a.interval() - b.interval()) > 1e-9 * std::abs(a.interval())) {
    throw std::invalid_argument(fmt::format(
        "acf_error: {} lags of {} and {} lags of {} do not compare; sample both at the same times", a.lags(),
        a.interval(), b.lags(), b.interval()));
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
