// SPDX-License-Identifier: BSL-1.0
// Lists of all names: systems, methods, families and metrics.
#pragma once

#include <string>

#include "comparison/described.hpp"

namespace nysalt::program {

/// As `list --json` prints it, with a system of the user's own if its file is named. Cost: the windows of
/// stability of all methods, some milliseconds.
json listing(const std::string& own_system = "");

}  // namespace nysalt::program
