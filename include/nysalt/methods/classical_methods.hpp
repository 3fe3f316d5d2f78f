// SPDX-License-Identifier: BSL-1.0
// Classical methods as data.
#pragma once

#include <vector>

#include "nysalt/methods/classical_table.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// A row of the table as a method.
tabulated as_data(const classical_row& row);

/// Rows without letters O that are not several steps of another: what a learned method is compared with.
std::vector<tabulated> classical_methods();

/// Classical methods that take n force evaluations a step: those that take as many, and those that
/// take a divisor, repeated with an equal part of the step.
std::vector<tabulated> classical_methods_of_cost(int evaluations);

}  // namespace nysalt
