// SPDX-License-Identifier: BSL-1.0
// Linear stability of methods that are data, compiled once for all commands.
#pragma once

#include <vector>

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/method.hpp"

namespace nysalt::program {

/// Whether a word has windows of stability that do not depend on the system: not one that rotates, nor one
/// with letters of one's own, whose action on oscillators is not known.
inline bool has_windows(const nysalt::word& word) { return !word.reads_modes && !word.has_own_letters(); }
stability_chart chart_of(const method& method);
std::vector<stability_window> stability_of(const nysalt::method& method);
double limit_of(const nysalt::method& method);
/// Of a step on the oscillator of z = h omega, without a bath.
double half_trace_of(const nysalt::method& method, double z);

}  // namespace nysalt::program
