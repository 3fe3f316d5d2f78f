// SPDX-License-Identifier: BSL-1.0

#include "nysalt/shard.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace nysalt {

shard::shard(std::int64_t total, const communicator& ranks) : total_(total), ranks_(&ranks) {
  const std::int64_t leaves = (total + trajectories_of_leaf - 1) / trajectories_of_leaf;
  blocks_ = leaves;
  while (blocks_ / 2 >= blocks_of_rank * ranks.size()) {
    blocks_ = (blocks_ + 1) / 2;
    ++level_;
  }
}

std::int64_t shard::first_of(int rank) const {
  const std::int64_t block = first_of_part(blocks_, rank, ranks_->size());
  return std::min(total_, (block << level_) * trajectories_of_leaf);
}

void shard::require_length(std::int64_t length, std::int64_t wanted) {
  if (length == wanted) return;
  throw std::invalid_argument(
      fmt::format("shard: items must be as many as trajectories of the rank, which brings its own to a sum, "
                  "got {} for {}",
                  length, wanted));
}

}  // namespace nysalt
