// SPDX-License-Identifier: BSL-1.0
// What a run is: that which decides its bytes, and what is told with them.
#pragma once

#include <cstdint>

#include "comparison/json.hpp"
#include "comparison/prepared_problem.hpp"
#include "program/settings.hpp"

namespace nysalt::program {

/// All that decides the bytes of the output, for a run that may be stopped and gone on with.
json question_of(const run_command& command, const prepared_problem& system, const tabulated& method,
                 std::int64_t steps, std::uint64_t seed);

/// What a file of arrays tells of itself: the same, in words too, with versions and units; nothing that
/// changes from time to time, from machine to machine, or with the number of threads or ranks.
json about_run(const run_command& command, const prepared_problem& system, const tabulated& method,
               std::int64_t steps, std::uint64_t seed);

}  // namespace nysalt::program
