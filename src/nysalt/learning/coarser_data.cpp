// SPDX-License-Identifier: BSL-1.0
#include "coarser_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace nysalt::detail {

flow_map_data coarser(const flow_map_data& data, int times) {
  const auto each = static_cast<std::size_t>(times);
  flow_map_data result;
  result.step = data.step * times;
  result.system = data.system;
  result.ensemble = data.ensemble;
  result.reference = data.reference;
  result.seed = data.seed;
  result.first_of.push_back(0);
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    const std::size_t whole = (data.first_of[m + 1] - data.first_of[m]) / each;
    for (std::size_t n = 0; n < whole; ++n) {
      const std::size_t first = data.first_of[m] + n * each;
      result.start.push_back(data.start[first]);
      result.finish.push_back(data.finish[first + each - 1]);
    }
    result.first_of.push_back(result.start.size());
  }
  if (!data.shared) return result;
  const shard share = data.share();
  std::vector<std::uint64_t> pairs(static_cast<std::size_t>(share.total()));
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    pairs[static_cast<std::size_t>(share.first()) + m] = result.first_of[m + 1] - result.first_of[m];
  }
  share.gather(pairs);
  std::size_t first = 0;
  std::size_t total = 0;
  for (std::size_t m = 0; m < pairs.size(); ++m) {
    if (static_cast<std::int64_t>(m) < share.first()) first += pairs[m];
    total += pairs[m];
  }
  result.shared = shared_pairs{share, first, total};
  return result;
}

after_steps_options in_longer_steps(const after_steps_options& how, int times, int shortest) {
  after_steps_options result = how;
  result.steps.clear();
  for (const int k : how.steps) {
    const int nearest = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) / times)));
    const int possible = std::min(nearest, shortest / times);
    if (possible >= 1 && (result.steps.empty() || result.steps.back() < possible))
      result.steps.push_back(possible);
  }
  result.apart = std::max(1, how.apart / times);
  return result;
}

}  // namespace nysalt::detail
