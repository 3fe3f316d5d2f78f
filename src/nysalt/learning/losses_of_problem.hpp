// SPDX-License-Identifier: BSL-1.0
// The parts of a problem of learning that depend on the loss and on its number of steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "../losses/data_loss.hpp"
#include "data_of_problem.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/learning/problem.hpp"

namespace nysalt::detail {

/// The held-out loss evaluated at every `times`-th step only; null if the trajectories are shorter.
using loss_by_times = std::function<std::shared_ptr<const data_loss>(int times)>;

/// From what the losses of a problem are made.
struct source_of_losses {
  const run_time_family& family;
  const model& system;
  const flow_map_data& data;
  const flow_map_data& held_out;
  loss_choice chosen;
  const other_loss* other;  // null: the chosen one is minimised
  coordinates which;
  std::shared_ptr<const metric> measure;  // in them
  int threads;
  bool in_lanes;
  std::shared_ptr<const flow_map_data> kept_held_out = {};  // null: rivals need none beyond the problem

  loss_inputs inputs(const flow_map_data& pairs, after_steps_options how) const {
    how.threads = threads;
    return {family, system, pairs, measure, std::move(how), in_lanes};
  }
  data_loss over(const flow_map_data& pairs, const after_steps_options& how) const {
    const auto from = inputs(pairs, how);
    if (other == nullptr) return chosen.kind->over_data(from);
    return in_lanes ? after_steps_of(from, *other->in_lanes) : after_steps_of(from, *other->one_by_one);
  }
  data_loss at_end() const {
    const int end = shortest_of(held_out);
    return of_states(inputs(held_out, {.steps = {end}, .apart = end}));
  }
  bool asks_data() const { return other != nullptr || chosen.kind->asks_data(); }
};

/// The loss over the kept held-out data by these times and by their multiples, made where it is first asked
/// for. Refers to nothing of `from`.
loss_by_times losses_by_times(const source_of_losses& from, const data_loss& held,
                              const after_steps_options& how);

/// Other methods at the cost of the family, by a loss of held-out data.
using rivals_by = std::function<std::optional<rival_method>(const tabulated&, const loss_by_times&)>;

/// Sets the members of `problem` that depend on the horizon of the loss, which is at most `most_steps` steps,
/// and `problem.shorter`, the same problem over a quarter of that horizon. `before` counts the evaluations of
/// other losses at this rank. Collective.
void put_losses(learning_problem& problem, const source_of_losses& from, const rivals_by& rival,
                const data_loss& at_end, int most_steps, const std::function<std::int64_t()>& before);

/// The mean over frequencies of the bands of |M - R|^2 in coordinates (omega q, p), M the matrix of one step
/// and R that of the exact flow; nothing for words with rotations, which are exact on their modes. Its minima
/// are starts of a search where the step is so large that no trajectory from elsewhere stays finite. Cost:
/// some microseconds.
objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step);

}  // namespace nysalt::detail
