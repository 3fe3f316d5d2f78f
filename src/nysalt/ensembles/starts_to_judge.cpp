// SPDX-License-Identifier: BSL-1.0

#include "nysalt/ensembles/starts_to_judge.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace nysalt {

namespace {

using state = phase_point<double, Eigen::Dynamic>;

/// Starts of trajectories first .. first + most - 1, or of as many as there are; made as many at a time as
/// the system has lanes.
std::vector<state> starts_made_in_lanes(const model& system, const initial_states& ensemble,
                                        std::uint64_t seed, std::int64_t first, std::int64_t most) {
  return detail::with_scalar_of(system, [&]<class T>(T) {
    std::vector<state> made;
    for (std::int64_t n = 0; n < most; n += lanes_in<T>) {
      const auto count = static_cast<int>(std::min<std::int64_t>(lanes_in<T>, most - n));
      try {
        const auto block = detail::sound_starts<T>(system, ensemble, seed, first + n, count);
        for (int k = 0; k < count; ++k) made.push_back(lane(block, k));
      } catch (const std::exception&) {
        if (n == 0) throw;
        break;  // it has no more
      }
    }
    return made;
  });
}

}  // namespace

phase_points starts_to_judge(const model& system, const initial_states& ensemble) {
  constexpr std::uint64_t seed = 1;  // of all judges: a verdict does not depend on the seed of a command
  constexpr std::int64_t enough = 512;
  constexpr std::int64_t if_expensive = 64;
  constexpr std::int64_t numbers = 2'000'000;  // 16 MB
  const std::int64_t that_fit = std::max<std::int64_t>(8, numbers / (2 * size(system)));
  std::int64_t wanted = std::min(ensemble.is_expensive() ? if_expensive : enough, that_fit);
  wanted = std::min(wanted, ensemble.size());
  phase_points result = starts_made_in_lanes(system, ensemble, seed, 0, wanted);
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

std::vector<state> detail::typical_and_energetic_starts(const model& system, const initial_states& ensemble,
                                                        std::uint64_t seed, std::int64_t first,
                                                        std::int64_t most_if_expensive) {
  constexpr auto plain = static_cast<std::int64_t>(detail::plain_starts);
  constexpr std::int64_t energetic = 64;
  constexpr std::int64_t pool = 896;
  constexpr double numbers = 2e6;  // 16 MB
  const auto that_fit = static_cast<std::int64_t>(numbers / (2.0 * static_cast<double>(size(system))));
  std::int64_t most =
      std::min(ensemble.is_expensive() ? std::min(energetic, most_if_expensive) : plain + pool, that_fit);
  most = std::min(most, ensemble.size() - first);
  std::vector<state> result;
  std::vector<std::pair<double, state>> by_energy;
  for (state& start : starts_made_in_lanes(system, ensemble, seed, first, most)) {
    if (std::ssize(result) < plain) {
      result.push_back(std::move(start));
    } else if (has_energy(system)) {
      by_energy.emplace_back(nysalt::energy<double>(system, start), std::move(start));
    }
  }
  const auto taken = std::min<std::ptrdiff_t>(energetic, std::ssize(by_energy));
  const auto is_higher = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::partial_sort(by_energy.begin(), by_energy.begin() + taken, by_energy.end(), is_higher);
  for (std::ptrdiff_t k = 0; k < taken; ++k) {
    result.push_back(std::move(by_energy[static_cast<std::size_t>(k)].second));
  }
  return result;
}

}  // namespace nysalt
