// SPDX-License-Identifier: BSL-1.0
#include "nysalt/learning/sound_force.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/learning/some_states.hpp"

namespace nysalt {

void require_sound_force(const model& system, const flow_map_data& data) {
  if (!system.facts().may_be_wrong) return;
  constexpr std::size_t enough = 4;
  std::vector<std::size_t> pairs;
  for (std::size_t k = 0; k < std::min(enough, data.all_pairs()); ++k) {
    pairs.push_back(data.all_pairs() * (2 * k + 1) / (2 * enough));
  }
  std::vector<Eigen::VectorXd> points;
  std::vector<Eigen::VectorXd> momenta;
  for (const auto& state : starts_of(data, size(system), pairs)) {
    points.emplace_back(state.q);
    momenta.emplace_back(state.p);
  }
  const force_check found =
      detail::check_force(system, points, momenta, finishes_of(data, size(system), pairs));
  if (found.passed()) return;
  throw std::invalid_argument(
      sentence("cannot learn on {}: {}; mend the system, or learn with check_force = false", describe(system),
               found.report()));
}

}  // namespace nysalt
