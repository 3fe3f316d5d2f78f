// SPDX-License-Identifier: BSL-1.0
// JSON with its keys in the order in which they were written.
#pragma once

#include <nlohmann/json.hpp>

namespace nysalt::program {

using json = nlohmann::ordered_json;

}  // namespace nysalt::program
