// SPDX-License-Identifier: BSL-1.0
// The modes of a stiffness matrix.
#pragma once

#include <Eigen/Core>

#include <string_view>

#include "nysalt/system.hpp"

namespace nysalt {

/// Normal modes of q K q/2 with K symmetric, and masses: M^{-1/2} K M^{-1/2} = U diag(omega^2) U^T. Cost:
/// O(N^3). Throws std::invalid_argument, in the name of who asks, unless K is square, finite and symmetric,
/// and no eigenvalue is negative beyond rounding.
normal_modes stiffness_modes(const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& inverse_masses,
                             std::string_view who);

}  // namespace nysalt
