// SPDX-License-Identifier: BSL-1.0

#include "nysalt/shard.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace nysalt {

shard::shard(std::int64_t total, const communicator& ranks, std::int64_t leaf)
    : total_(total), leaf_(leaf), ranks_(&ranks) {
  blocks_ = (total + leaf - 1) / leaf;
  while (blocks_ / 2 >= blocks_of_rank * ranks.size()) {
    blocks_ = (blocks_ + 1) / 2;
    ++level_;
  }
}

std::int64_t shard::first_of(int rank) const {
  const std::int64_t block = detail::first_of_part(blocks_, rank, ranks_->size());
  return std::clamp<std::int64_t>((block << level_) * leaf_ - known_, 0, total_);
}

void shard::require_length(std::int64_t length, std::int64_t wanted) {
  if (length == wanted) return;
  throw std::invalid_argument(
      fmt::format("shard: items must be as many as trajectories of the rank, which brings its own to a sum, "
                  "got {} for {}",
                  length, wanted));
}

}  // namespace nysalt
