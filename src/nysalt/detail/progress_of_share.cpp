// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/progress_of_share.hpp"

#include <cstdint>
#include <functional>

namespace nysalt {

std::function<void(std::int64_t)> progress_of_share(const communicator& ranks, std::int64_t count,
                                                    std::int64_t total,
                                                    const std::function<void(std::int64_t)>& progress) {
  if (!progress || ranks.is_single()) return progress;
  if (!ranks.is_first()) return {};
  return [progress, count, total](std::int64_t done) {
    const double share = static_cast<double>(done) / static_cast<double>(count);
    progress(static_cast<std::int64_t>(share * static_cast<double>(total)));
  };
}

}  // namespace nysalt
