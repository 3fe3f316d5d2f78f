// SPDX-License-Identifier: BSL-1.0
// One rank's progress, told as that of all.
#pragma once

#include <cstdint>
#include <functional>

#include "nysalt/communicator.hpp"

namespace nysalt {

/// What to tell of the progress with `count` trajectories, those of this rank, so that `progress` hears of
/// all `total`. Shares are equal but for a little: rank 0 tells of its own as if it were the whole, and the
/// others are silent.
std::function<void(std::int64_t)> progress_of_share(const communicator& ranks, std::int64_t count,
                                                    std::int64_t total,
                                                    const std::function<void(std::int64_t)>& progress);

}  // namespace nysalt
