// SPDX-License-Identifier: BSL-1.0
// Fits a family to the flow map of a system at a step.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/detail/requirements.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// theta that minimises a loss over `data`: that of the options, by default the state's error at several
/// times of whole trajectories, in a bath the one-step loss [li_lu_tao_ye_2023, section 3.1], or one
/// own_loss. The search begins at the family's own start, its classical members, random starts and what the
/// options add, and goes in stages, see loss_kind. Of several minima it is the one that the loss's
/// judge_of_minima likes best, among those that the stability_guard admits and that withstand a trial run of
/// planned_steps steps; see learning/search.hpp for where there is none. It is not worse, by the loss on
/// held-out data, than a member of the family that was known before; and the summary names the best classical
/// method of the same cost where that is as good. The held-out data should come from another seed.
///
/// Throws std::invalid_argument if the data are of another system, of two steps or not finite, if
/// check_force() finds the system's force, kick or derivative wrong at some states of the data (unless
/// check_force = false), if the system does not serve the family's letters, or if the coordinates, the loss
/// (or two of them), a start, a fixed value, max_iterations or threads are out of range. A fit that cannot be
/// trusted is returned with usable = false. Cost: some 40 passes over a part of the data for each start, and
/// some 20 to 200 over all for each of three minima, each a step with derivatives a pair. Memory: some five
/// copies of the data.
template <SeparableSystem S, class... Own>
  requires(sizeof...(Own) <= 1)
fit learn(const run_time_family& family, const S& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options = {}, const own_loss<Own>&... own) {
  if constexpr (sizeof...(Own) == 0) {
    return detail::learn(family, system, data, held_out, options);
  } else {
    const auto other = detail::without_type(system, own...);
    return detail::learn(family, system, data, held_out, options, &other);
  }
}

}  // namespace nysalt
