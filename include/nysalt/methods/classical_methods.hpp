// SPDX-License-Identifier: BSL-1.0
// All classical methods of the library, as data.
#pragma once

#include <vector>

#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// Methods with fixed coefficients and without letters O: what a learned method is compared with.
std::vector<tabulated> classical_methods();

/// Classical methods that take so many force evaluations a step: those that take as many, and those that
/// take a divisor, repeated with an equal part of the step.
std::vector<tabulated> classical_methods_of_cost(int evaluations);

}  // namespace nysalt
