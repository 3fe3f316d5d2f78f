// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted.
#pragma once

#include <string>
#include <vector>

#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/shard.hpp"

namespace nysalt::detail {

/// Standard error of sum_m (a_m - b_m) over independent trajectories m; infinite, as
/// nothing is known, if there is but one.
double noise_of_difference(const std::vector<double>& a, const std::vector<double>& b, const shard& share);

/// Why a fit should not be used; empty if it may be. Settled: it converged, or is held by the guard.
std::string objection(const fit_summary& fit, bool settled, const std::string& instability);

}  // namespace nysalt::detail
