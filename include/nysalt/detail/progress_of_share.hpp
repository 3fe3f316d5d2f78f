// SPDX-License-Identifier: BSL-1.0
// One rank's progress, reported as that of all.
#pragma once

#include <cstdint>
#include <functional>

#include "nysalt/communicator.hpp"

namespace nysalt {

/// A counter for the `count` trajectories of this rank, such that `progress` counts to `total`, those of all
/// ranks. Shares are nearly equal: rank 0 scales its own count, and the others report nothing.
std::function<void(std::int64_t)> progress_of_share(const communicator& ranks, std::int64_t count,
                                                    std::int64_t total,
                                                    const std::function<void(std::int64_t)>& progress);

}  // namespace nysalt
