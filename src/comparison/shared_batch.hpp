// SPDX-License-Identifier: BSL-1.0
// Trajectories that are stepped at a time, shared by the ranks; what comes of them goes to rank 0.
#pragma once

#include <cstdint>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/shard.hpp"
#include "sampled_run.hpp"

namespace nysalt::program {

/// Trajectories first .. first + count - 1. Each rank has consecutive ones, in whole blocks of as many as are
/// stepped together, rank 0 the first; one may have none. All but first() and count() is collective.
class shared_batch {
 public:
  shared_batch(std::int64_t first, std::int64_t count, int lanes, const communicator& ranks);

  /// Of this rank.
  std::int64_t first() const { return first_ + share_.first(); }
  std::int64_t count() const { return share_.count(); }

  /// take(m, record) at rank 0, in the order of the trajectories, of each that has samples or is lost. One
  /// trajectory of another rank is in its memory at a time. What take() throws is thrown at all ranks.
  void deliver(const std::vector<record>& own, const record_taker& take) const;
  /// All of them at rank 0, elsewhere nothing.
  saved_runs gather(saved_runs own) const;
  /// Of all, which rank 0 has, each gets its own.
  saved_runs scatter(const saved_runs& all) const;

 private:
  std::int64_t first_of(int rank) const { return first_ + share_.first_of(rank); }

  std::int64_t first_;
  shard share_;
  const communicator* ranks_;
};

}  // namespace nysalt::program
