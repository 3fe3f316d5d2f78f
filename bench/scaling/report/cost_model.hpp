// SPDX-License-Identifier: BSL-1.0
// The formulas of docs/scaling.md: seconds and bytes of R ranks that share M trajectories.
#pragma once

#include <algorithm>
#include <cstdint>

#include "least_squares.hpp"
#include "nysalt/core/tree_sum.hpp"

namespace nysalt::bench {

/// M_r of the rank that has most, as `shard` has it: 2^k leaves a block, k as large as leaves 32 blocks a
/// rank.
inline std::int64_t largest_share_of(std::int64_t trajectories, std::int64_t ranks) {
  std::int64_t leaf = detail::trajectories_of_leaf;
  std::int64_t blocks = (trajectories + leaf - 1) / leaf;
  while (blocks / 2 >= 32 * ranks) {
    blocks = (blocks + 1) / 2;
    leaf *= 2;
  }
  return std::min(trajectories, leaf * ((blocks + ranks - 1) / ranks));
}

/// Levels of the tree over the ranks: ceil(log2 R).
inline int levels_over(std::int64_t ranks) {
  int result = 0;
  while ((std::int64_t{1} << result) < ranks) ++result;
  return result;
}

/// Bytes of the sum that a pass over the data makes for P parameters: r^T r, J^T r and half of J^T J.
inline double bytes_of_pass(int parameters) {
  return 8.0 * (1 + parameters + parameters * (parameters + 1) / 2);
}

/// T_red(R) = a + a' bytes + ceil(log2 R) (b + beta bytes).
struct reduction_costs {
  cost here;
  cost here_byte;
  cost level;
  cost level_byte;

  double seconds(std::int64_t ranks, double bytes) const {
    return here.value + here_byte.value * bytes +
           levels_over(ranks) * (level.value + level_byte.value * bytes);
  }
};

/// T_run = t_step n M_r + t_start M_r.
struct stepping_costs {
  cost step;
  cost start;

  double seconds(double steps, double share) const { return (step.value * steps + start.value) * share; }
};

/// T = t_pair P_r + t_0: making data, and what is no message of a pass or of all of learn().
struct pairs_costs {
  cost pair;
  cost none;

  double seconds(double pairs) const { return pair.value * pairs + none.value; }
};

/// Bytes of a rank: c_0 + c_pair P_r + c_trajectory M_r, data and held-out data of P_r pairs each.
struct memory_costs {
  cost none;
  cost pair;
  cost trajectory;

  double bytes(double pairs, double share) const {
    return none.value + pair.value * pairs + trajectory.value * share;
  }
};

/// What is assumed of the machine where nothing was measured.
struct cluster {
  std::int64_t ranks = 10'000;
  double latency = 2e-6;    // seconds of a message between machines
  double bandwidth = 1e10;  // bytes a second into one rank: a link of 100 Gbit/s, less what it takes itself
  double spread = 0.05;     // the slowest rank's time over the median one's, less 1
  double start_up = 30.0;   // seconds until all ranks run
  double disk = 1e9;        // bytes a second that one rank writes to a shared file system

  /// Up the tree and down: two messages a level. What a rank does by itself is as measured.
  reduction_costs reduction(const reduction_costs& measured) const {
    return {measured.here, measured.here_byte, {2.0 * latency, 0.0}, {2.0 / bandwidth, 0.0}};
  }
};

}  // namespace nysalt::bench
