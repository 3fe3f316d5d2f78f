// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt::detail {

/// Throws std::invalid_argument, in the name of `who`, if the method is not reversible, the system is in a
/// bath that acts, or kT is not positive and finite.
void require_metropolis_applies(const char* who, const model& system, const tabulated& method,
                                double temperature);

}  // namespace nysalt::detail
