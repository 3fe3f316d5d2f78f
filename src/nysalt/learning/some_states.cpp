// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/some_states.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "nysalt/derivatives/force_jacobian.hpp"
#include "nysalt/ensembles/typical_and_energetic.hpp"

namespace nysalt {

namespace {

/// Of this rank's states, those of some pairs of all, by their numbers, which rise: at all ranks.
phase_points states_of(const phase_points& mine, const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs) {
  const auto size = static_cast<std::size_t>(dimension);
  std::vector<double> numbers;  // q and p of one after the other
  for (const std::size_t pair : pairs) {
    if (pair < data.first_pair() || pair >= data.first_pair() + data.pairs()) continue;
    const auto x = mine[pair - data.first_pair()];
    numbers.insert(numbers.end(), x.q.begin(), x.q.end());
    numbers.insert(numbers.end(), x.p.begin(), x.p.end());
  }
  numbers = all_gather(data.share().ranks(), numbers);
  phase_points result(pairs.size(), dimension);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double* q = numbers.data() + 2 * size * k;
    result.set(k, listed_point<Eigen::Map<const Eigen::VectorXd>>{{q, dimension}, {q + size, dimension}});
  }
  return result;
}

/// Numbers, among those of all ranks, of the pairs at whose starts the force changes most along itself and
/// along a direction of chance: where the highest frequency may be.
std::vector<std::size_t> stiffest_pairs(const model& system, const flow_map_data& data, std::size_t most) {
  std::vector<double> scored;  // a score and a number, of one pair after the other
  {
    const auto motion = starts_of(data, size(system), detail::spread_pairs(data.all_pairs(), most));
    force_jacobian<field::whole, model> jacobian(system, motion);
    auto v = make_vector<double>(system);
    std::mt19937_64 bits{1};
    auto chance = v;
    for (double& x : chance) x = static_cast<double>(bits() >> 11U) * 0x1p-53 - 0.5;
    chance /= chance.norm();
    std::vector<std::pair<double, std::size_t>> scores;
    for (std::size_t pair = 0; pair < data.pairs(); ++pair) {
      const Eigen::VectorXd q = data.start[pair].q;
      force<double>(system, q, v);
      const double length = v.norm();
      if (length > 0.0) v /= length;
      v += chance;
      jacobian.move_to(q);
      const double score = jacobian.times(v).norm();
      if (std::isfinite(score)) scores.emplace_back(-score, data.first_pair() + pair);  // the largest first
    }
    const auto kept = static_cast<std::ptrdiff_t>(std::min(most, scores.size()));
    std::partial_sort(scores.begin(), scores.begin() + kept, scores.end());
    for (std::ptrdiff_t k = 0; k < kept; ++k) {
      scored.push_back(scores[static_cast<std::size_t>(k)].first);
      scored.push_back(static_cast<double>(scores[static_cast<std::size_t>(k)].second));
    }
    scored = all_gather(data.share().ranks(), scored);
  }
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t k = 0; k + 1 < scored.size(); k += 2) {
    all.emplace_back(scored[k], static_cast<std::size_t>(scored[k + 1]));
  }
  std::ranges::sort(all);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < std::min(most, all.size()); ++k) result.push_back(all[k].second);
  return result;
}

}  // namespace

phase_points starts_of(const flow_map_data& data, Eigen::Index dimension,
                       const std::vector<std::size_t>& pairs) {
  return states_of(data.start, data, dimension, pairs);
}

phase_points finishes_of(const flow_map_data& data, Eigen::Index dimension,
                         const std::vector<std::size_t>& pairs) {
  return states_of(data.finish, data, dimension, pairs);
}

states_of_data some_states(const model& system, const flow_map_data& data) {
  constexpr std::size_t spread = 128;
  constexpr std::size_t stiffest = 32;
  auto result = starts_of(data, size(system), detail::spread_pairs(data.all_pairs(), spread));
  const std::size_t typical = result.size();
  auto pairs = stiffest_pairs(system, data, stiffest);
  std::ranges::sort(pairs);
  result.append(starts_of(data, size(system), pairs));
  result.append(data.further_starts);
  return {std::move(result), typical};
}

phase_points judged_starts_of(const model& system, const flow_map_data& data, const flow_map_data& held_out) {
  if (!data.judged_starts.empty()) return data.judged_starts;
  constexpr std::size_t most = 512;
  const auto trajectories = static_cast<std::size_t>(held_out.share().total());
  std::vector<std::size_t> pairs;
  for (const std::size_t m : detail::spread_pairs(trajectories, most)) {
    // The first pair of a trajectory, where all are of one length; else a state of the same motion.
    pairs.push_back(m * (held_out.all_pairs() / trajectories));
  }
  return starts_of(held_out, size(system), pairs);
}

}  // namespace nysalt
