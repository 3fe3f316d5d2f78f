// SPDX-License-Identifier: BSL-1.0
// Linear stability of methods that are data, compiled once for all commands.
#pragma once

#include <vector>

#include "nysalt/derivatives/stability_window.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt::program {

stability_chart chart_of(const tabulated& method);
std::vector<stability_window> stability_of(const tabulated& method);
double limit_of(const tabulated& method);
/// Of a step on the oscillator of z = h omega, without a bath.
double half_trace_of(const tabulated& method, double z);

}  // namespace nysalt::program
