// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// The error of the state in the energy norm, e^2 = sum_k w_k^2 dx_k^2 + dy_k^2 in the system's modes
/// x = U^T M^{1/2} q, y = U^T M^{-1/2} p: sqrt(mean over trajectories and times of e^2), absolute. A mode of
/// frequency zero has weight 1; a system without modes() is measured in mass-weighted coordinates, all
/// weights 1. Throws std::invalid_argument if modes() has not the system's size. Cost of a sample: a product
/// with each entry of 2 N modes that is not zero.
error_measure state_measure(const model& system);

}  // namespace nysalt
