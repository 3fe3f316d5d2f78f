// SPDX-License-Identifier: BSL-1.0
// What nysalt_scaling measures.
#pragma once

#include <cstdint>
#include <filesystem>

namespace nysalt::bench {

void measure_stepping();
void measure_learning();
void measure_writing(const std::filesystem::path& folder);
void measure_reductions();
void measure_memory(std::int64_t trajectories, std::int64_t steps);

}  // namespace nysalt::bench
