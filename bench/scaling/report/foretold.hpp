// SPDX-License-Identifier: BSL-1.0
// Jobs on a cluster, from what was fitted on one machine and what is assumed of the other.
#pragma once

#include <cstdint>
#include <functional>

#include "fitted.hpp"

namespace nysalt::bench {

class foretold {
 public:
  foretold(const fitted& model, const cluster& where)
      : model_(model), where_(where), reduction_(where.reduction(model.reduction)) {}

  /// One sum over all ranks.
  double sum(std::int64_t ranks) const {
    return ranks > 1 ? reduction_.seconds(ranks, bytes_of_pass(2)) : 0.0;
  }

  /// Data and held-out data.
  double making_data(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return 2.0 * of_slowest(model_.data.pair.value * pairs(trajectories, steps, ranks), ranks) +
           model_.data.none.value;
  }
  /// What a rank does in a pass, before it waits for others.
  double work_of_pass(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return of_slowest(model_.pass.pair.value * pairs(trajectories, steps, ranks), ranks) +
           model_.pass.none.value;
  }
  double pass(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return work_of_pass(trajectories, steps, ranks) + sum(ranks);
  }
  /// The part of learn() that each rank does again, whatever the data.
  double serial() const { return model_.learn.none.value; }
  double learning(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return of_slowest(model_.learn.pair.value * pairs(trajectories, steps, ranks), ranks) + serial() +
           model_.passes() * sum(ranks);
  }
  double memory(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return model_.memory.bytes(pairs(trajectories, steps, ranks), share(trajectories, ranks));
  }

  /// BAOAB, with so many sums over all ranks on the way.
  double run(std::int64_t trajectories, double steps, double looks, std::int64_t ranks) const {
    return of_slowest(model_.baoab.seconds(steps, share(trajectories, ranks)), ranks) + looks * sum(ranks);
  }

  double pairs(std::int64_t trajectories, std::int64_t steps, std::int64_t ranks) const {
    return share(trajectories, ranks) * static_cast<double>(steps);
  }
  static double share(std::int64_t trajectories, std::int64_t ranks) {
    return static_cast<double>(largest_share_of(trajectories, ranks));
  }

  /// The fewest ranks whose sum takes a tenth of their pass; in steps of a tenth.
  std::int64_t ranks_of_dear_sums(std::int64_t trajectories, std::int64_t steps) const {
    double ranks = 2.0;
    const auto whole = [&] { return static_cast<std::int64_t>(ranks); };
    while (10.0 * sum(whole()) < pass(trajectories, steps, whole())) ranks *= 1.1;
    return whole();
  }

 private:
  double of_slowest(double seconds, std::int64_t ranks) const {
    return ranks > 1 ? seconds * model_.slower * (1.0 + where_.spread) : seconds;
  }

  fitted model_;
  cluster where_;
  reduction_costs reduction_;
};

/// T(1)/(R T(R)) for the same job.
inline double efficiency(const std::function<double(std::int64_t)>& seconds, std::int64_t ranks) {
  return seconds(1) / (static_cast<double>(ranks) * seconds(ranks));
}

}  // namespace nysalt::bench
