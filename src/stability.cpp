// SPDX-License-Identifier: BSL-1.0
#include "stability.hpp"

#include "nysalt/derivatives/linear_stability.hpp"

namespace nysalt::program {

std::vector<stability_window> stability_of(const tabulated& method) { return stability_windows(method); }
double limit_of(const tabulated& method) { return stability_limit(method); }

}  // namespace nysalt::program
