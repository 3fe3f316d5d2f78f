// SPDX-License-Identifier: BSL-1.0
// The distance between two autocovariances.
#pragma once

#include "nysalt/analysis/autocovariance.hpp"

namespace nysalt {

/// A distance of two autocovariances with a standard error.
struct acf_distance {
  double rms;             ///< root mean square difference over the lags 1..L
  double standard_error;  ///< standard error of rms
  double floor;           ///< expected rms of sampling error only
};

/// rms = sqrt(1/L sum_{k=1..L} (rho_a(k) - rho_b(k))^2) of the normalised autocovariances, with the standard
/// error of independent ensembles; floor^2 = 1/L sum_k (error_a(k)^2 + error_b(k)^2), the mean of rms^2 if
/// both have one distribution. If a and b share starts or noise, error and floor are larger than needed.
/// Throws std::invalid_argument if lags or intervals (to 1e-9 relative, as steps are typed in decimals)
/// differ, and like autocovariance::normalised.
acf_distance acf_error(const autocovariance& a, const autocovariance& b);

}  // namespace nysalt
