// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/reference.hpp"

namespace nysalt {

/// The exact flow of a linear system, mode by mode: x(t) = cos(w t) x + sin(w t)/w y,
/// y(t) = -w sin(w t) x + cos(w t) y with x = U^T M^{1/2} q, y = U^T M^{-1/2} p. The error is rounding. The
/// reference belongs to one linear system and refuses any other, where the error would not be noticed.
///
/// Throws std::invalid_argument if a bath acts, the system declares no modes, they are not orthonormal or the
/// force is not the linear one that they describe. Cost: 9 forces; then in each interval four products for
/// each entry of the basis that is not zero.
reference exact_linear(const model& system);

}  // namespace nysalt
