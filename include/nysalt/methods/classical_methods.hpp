// SPDX-License-Identifier: BSL-1.0
// Classical methods as data.
#pragma once

#include <vector>

#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt {

/// A row of the table as a method.
tabulated as_data(const classical_row& row);

/// Rows without letters O that are not several steps of another: what a learned method is compared with.
std::vector<tabulated> classical_methods();

}  // namespace nysalt
