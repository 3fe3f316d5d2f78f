// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/starts_to_judge.hpp"

#include <algorithm>
#include <exception>

namespace nysalt {

phase_points starts_to_judge(const model& system, const initial_states& ensemble) {
  constexpr std::uint64_t seed = 1;  // of all judges: a verdict does not depend on the seed of a command
  constexpr std::int64_t enough = 512;
  constexpr std::int64_t if_expensive = 64;
  constexpr std::int64_t numbers = 2'000'000;  // 16 MB
  const std::int64_t that_fit = std::max<std::int64_t>(8, numbers / (2 * size(system)));
  std::int64_t wanted = std::min(ensemble.is_expensive() ? if_expensive : enough, that_fit);
  wanted = std::min(wanted, ensemble.size());
  phase_points result = detail::with_scalar_of(system, [&]<class T>(T) {
    phase_points made;
    for (std::int64_t n = 0; n < wanted; n += lanes_in<T>) {
      const auto count = static_cast<int>(std::min<std::int64_t>(lanes_in<T>, wanted - n));
      phase_point<T, Eigen::Dynamic> block;
      try {
        block = sound_starts<T>(system, ensemble, seed, n, count);
      } catch (const std::exception&) {
        if (n == 0) throw;
        break;  // it has no more
      }
      for (int k = 0; k < count; ++k) made.push_back(lane(block, k));
    }
    return made;
  });
  const auto is_first = [&](std::size_t k) {
    return result[k].q == result[0].q && result[k].p == result[0].p;
  };
  std::size_t equal = 1;
  while (equal < result.size() && is_first(equal)) ++equal;
  if (equal == result.size()) result.resize(1);  // one start, again and again
  constexpr std::size_t in_bath = 192;           // as each has noise of its own
  const std::size_t given = result.size();
  for (std::size_t k = 0; system.bath().acts() && given > 0 && result.size() < in_bath; ++k) {
    result.push_back(phase_point<double, Eigen::Dynamic>(result[k % given]));
  }
  return result;
}

}  // namespace nysalt
