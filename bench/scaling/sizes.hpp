// SPDX-License-Identifier: BSL-1.0
// How large the work is, on how many ranks and threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "first_ranks.hpp"
#include "nysalt/shard.hpp"

namespace nysalt::bench {

struct size_of_work {
  std::string scaling;  // strong: so much in all; weak: so much a rank; size: other sizes on one rank
  const first_ranks* who;
  int threads;
  std::int64_t trajectories;
  std::int64_t steps;  // of each
};

/// 1, 2, 4, ... and all ranks of the job.
inline std::deque<first_ranks> numbers_of_ranks() {
  std::deque<first_ranks> result;
  for (int size = 1; size < size_of_job(); size *= 2) result.emplace_back(size);
  result.emplace_back(size_of_job());
  return result;
}

/// One rank first. Two threads of one rank stand beside two ranks.
inline std::vector<size_of_work> strong_and_weak(const std::deque<first_ranks>& all,
                                                 std::int64_t trajectories, std::int64_t steps) {
  std::vector<size_of_work> result;
  for (const first_ranks& who : all) {
    result.push_back({"strong", &who, 1, trajectories, steps});
    if (who.size() == 2) result.push_back({"strong", &all.front(), 2, trajectories, steps});
  }
  for (const first_ranks& who : all) {
    if (who.size() > 1) result.push_back({"weak", &who, 1, trajectories * who.size(), steps});
  }
  return result;
}

inline std::int64_t largest_share(const shard& all) {
  std::int64_t result = 0;
  for (int r = 0; r < all.ranks().size(); ++r)
    result = std::max(result, all.first_of(r + 1) - all.first_of(r));
  return result;
}

inline nlohmann::ordered_json row_of(const std::string& what, const size_of_work& size) {
  const shard all(size.trajectories, size.who->ranks());
  return {{"what", what},
          {"scaling", size.scaling},
          {"ranks", size.who->size()},
          {"threads", size.threads},
          {"trajectories", size.trajectories},
          {"steps", size.steps},
          {"largest_share", largest_share(all)}};
}

}  // namespace nysalt::bench
