// SPDX-License-Identifier: BSL-1.0
// What there is by name: systems, methods, families and metrics.
#pragma once

#include "json.hpp"

namespace nysalt::program {

/// As `list --json` prints it. Cost: the windows of stability of all methods, some milliseconds.
json listing();

}  // namespace nysalt::program
