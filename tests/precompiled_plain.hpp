// SPDX-License-Identifier: BSL-1.0
// What most tests include of other libraries, to be precompiled.
#pragma once

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "../cmake/precompiled.hpp"
