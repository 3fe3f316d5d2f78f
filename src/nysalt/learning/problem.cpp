// SPDX-License-Identifier: BSL-1.0
// From a system, its data and a family to a problem that knows none of them.

#include "nysalt/learning/problem.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "data_of_problem.hpp"
#include "losses_of_problem.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

namespace {

/// Whether a change to modes costs a pass over the coordinates, and no product with a full matrix.
bool has_cheap_modes(const model& system) {
  if (!has_modes(system)) return false;
  const auto each = std::ssize(modal_coordinates::of(system)->entries()) / size(system);
  return each <= most_for_all_frequencies;
}

/// Those that were asked for; else the energy coordinates where the loss is of them and they are cheap, else
/// qp.
coordinates coordinates_of(const model& system, const fit_options& options, bool is_of_energy_norm) {
  if (options.coordinates) return *options.coordinates;
  return is_of_energy_norm && has_cheap_modes(system) ? coordinates::energy : coordinates::qp;
}

/// A summary must not take one loss for another, and names it in a line.
void require_name(const std::string& name) {
  std::vector<std::string_view> taken;
  for (const loss_kind* kind : losses()) taken.push_back(kind->name);
  const bool is_taken = std::ranges::find(taken, name) != taken.end();
  if (!name.empty() && !is_taken && name.find_first_of("\n\r") == std::string::npos) return;
  const auto last = taken.back();
  taken.pop_back();
  throw std::invalid_argument(
      fmt::format("learn: the name of an own loss must be one line and none of {1} and {2}, got '{0}'", name,
                  fmt::join(taken, ", "), last));
}

/// Where a word has its letters O; nothing if it has none, or not as placement says.
std::optional<placement> placement_in(const run_time_word& word) {
  const std::string& letters = word.letters();
  constexpr char o = ornstein_uhlenbeck::letter;
  if (word.stochastic_letters == 2 && letters.front() == o && letters.back() == o)
    return placement::symmetric;
  if (word.stochastic_letters != 1) return std::nullopt;
  return letters.back() == o ? placement::end : placement::middle;
}

/// The guard that knows the frequencies along both sets of data.
stability_guard guard_along(const model& system, const flow_map_data& data, const flow_map_data& held_out,
                            const run_time_word& word, const fit_options& options) {
  auto [states, typical] = some_states(system, data);
  states.append(some_states(system, held_out).states);
  // Over ten thousand steps, as at first: what grows more slowly a trial run shows.
  constexpr std::int64_t most_steps = 10'000;
  return {system, states, word, std::min(options.planned_steps, most_steps), typical};
}

/// Whether the letters are served, in lanes or one by one, with their derivatives by theta.
void require_served_with_slopes(const run_time_word& letters, const model& system, bool in_lanes) {
  require_served<model, double>(letters, system);
  if (in_lanes) {
    require_served<model, detail::lanes_with_slopes>(letters, system);
  } else {
    require_served<model, dual<double, directions_at_a_time>>(letters, system);
  }
}

/// A problem of data that are as they should be.
learning_problem make_problem(const detail::source_of_losses& from, fit_options options) {
  const auto& [family, system, data, held_out, chosen, other, which, measure, threads, in_lanes, kept] = from;
  const loss_kind& kind = *chosen.kind;
  if (other == nullptr && kind.is_of_proposals) {
    const int shortest = std::min(detail::shortest_of(data), detail::shortest_of(held_out));
    options.planned_steps = std::min<std::int64_t>(options.planned_steps, shortest);
  }
  const communicator& ranks = data.share().ranks();
  const auto one_step = of_states(from.inputs(held_out, {}));
  const auto at_end = from.at_end();
  learning_problem problem{.family = family,
                           .options = options,
                           .step = data.step,
                           .loss = {},
                           .scores = {},
                           .held_out = held_out.share(),
                           .held_out_losses = {},
                           .one_step_loss = one_step.value,
                           .loss_at_end = at_end.value,
                           .judge = {},
                           .evaluations = {},
                           .judged = {},
                           .rival = {},
                           .guard = guard_along(system, data, held_out, family.letters, options),
                           .facts = {}};
  problem.validity = {data.step, data.system, kind_of(system), data.energies};
  problem.is_of_black_box = is_black_box(system);
  problem.is_in_bath = system.bath().acts();
  if (options.frequency) {
    problem.frequency_to_fit = *options.frequency;
  } else if (has_modes(system)) {
    problem.frequency_to_fit = frequency_to_fit(system);
  }
  problem.judged = [system = system, starts = judged_starts_of(system, data, held_out),
                    how = judging_options{.steps = options.planned_steps,
                                          .threads = options.threads,
                                          .watches_energy = other != nullptr || !kind.is_of_proposals},
                    judges = std::make_shared<std::map<double, step_judge>>()](const tabulated& method,
                                                                               double step) {
    auto judge = judges->find(step);
    if (judge == judges->end()) judge = judges->emplace(step, step_judge(system, starts, step, how)).first;
    return judge->second.of(method);
  };
  const auto place = placement_in(family.letters);
  const detail::rivals_by rival =
      [system = system, family = family, place, in_lanes = in_lanes, step = data.step](
          const tabulated& method, const detail::loss_by_times& held) -> std::optional<rival_method> {
    if (method.requires_quadratic_kinetic && !has_quadratic_kinetic(system)) return std::nullopt;
    const run_time_word& word = method.letters();
    const int ours = family.letters.evaluations_per_step;
    const int theirs = word.evaluations_per_step;
    if (ours < 1 || theirs < 1) return std::nullopt;
    // `steps` steps of the family last as long, and cost as much, as `times` of the method.
    const int steps = theirs / std::gcd(ours, theirs);
    const int times = ours / std::gcd(ours, theirs);
    const bool is_in_bath = family.letters.stochastic_letters > 0;
    if (steps > 1 && (is_in_bath || family.letters.is_processed())) return std::nullopt;
    if ((steps > 1 || times > 1) && word.is_processed()) return std::nullopt;
    const tabulated over = repeated(method, times);
    run_time_family as_family(over.name(), over.letters(), over.coefficients());
    if (is_in_bath) {
      if (!place || as_family.letters.is_processed()) return std::nullopt;
      if (*place == placement::middle && as_family.letters.length % 2 == 0) return std::nullopt;
      as_family = thermostatted(as_family, *place);
    }
    try {
      require_served_with_slopes(as_family.letters, system, in_lanes);
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
    const auto losses = held(steps);
    if (losses == nullptr) return std::nullopt;
    rival_method result{
        .name = method.name(),
        .held_out_losses = losses->by_trajectory_of(as_family),
        .method = is_in_bath ? tabulated(method.name(), as_family.letters, as_family.coefficients({}), method)
                             : method};
    result.step = step * theirs / ours;
    result.judged_step = is_in_bath ? step : result.step;
    if (steps > 1) {
      result.losses_beside = [losses, family, steps](const Eigen::VectorXd& theta) {
        const tabulated member(family.name, family.letters, family.coefficients(theta), {1, false, false});
        const tabulated all = repeated(member, steps);
        return losses->by_trajectory_of({all.name(), all.letters(), all.coefficients()});
      };
    }
    return result;
  };
  fit_summary& facts = problem.facts;
  facts.family = family.name;
  facts.system = data.system;
  facts.reference = data.reference;
  facts.ensemble = data.ensemble;
  facts.coordinates = to_string(which);
  facts.loss_name = other ? other->description : chosen.description();
  facts.is_of_data = from.asks_data();
  facts.derivatives = system.facts().derivative_source;
  facts.step = data.step;
  facts.seed = data.seed;
  facts.held_out_seed = held_out.seed;
  facts.held_out_is_new = !detail::begin_alike(data, held_out);
  facts.guard = problem.guard.description();
  facts.coordinates_used = measure->residuals();
  facts.dropped = measure->dropped();
  facts.samples = data.all_pairs();
  facts.trajectories = static_cast<std::size_t>(data.share().total());
  facts.held_out_samples = held_out.all_pairs();
  facts.reference_checked = ranks.sum(std::ssize(data.finer)) > 0;
  if (facts.reference_checked) facts.reference_error = detail::error_of_reference(data, *measure);
  facts.data_seconds = data.seconds + held_out.seconds;
  detail::put_losses(problem, from, rival, at_end, std::numeric_limits<int>::max(),
                     [=] { return one_step.evaluations() + at_end.evaluations(); });
  return problem;
}

}  // namespace

namespace detail {

learning_problem make_learning_problem(const run_time_family& family, const model& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const other_loss* other) {
  if (other != nullptr) {
    require_name(other->name);
    if (options.loss) {
      throw std::invalid_argument(
          fmt::format("learn: the loss must be one, got {} and {}; leave the loss of the options away",
                      options.loss->description(), other->description));
    }
  }
  require_valid(data, system);
  require_valid(held_out, system);
  const bool in_lanes = system.facts().in_lanes_with_slopes && (other == nullptr || other->in_lanes);
  require_served_with_slopes(family.letters, system, in_lanes);
  if (held_out.step != data.step) {
    throw std::invalid_argument(fmt::format(
        "learn: data and held-out data must have the same step, got {} and {}", data.step, held_out.step));
  }
  if (&held_out.share().ranks() != &data.share().ranks()) {
    throw std::invalid_argument("learn: the data and the held-out data must be shared by the same ranks");
  }
  const loss_choice chosen = options.loss.value_or(usual_loss(system.bath()));
  const loss_kind& kind = *chosen.kind;
  if (other == nullptr && !family.letters.is_symplectic && !kind.is_for_sampling) {
    throw std::invalid_argument(fmt::format(
        "learn: the family must be symplectic except for sampling, got {} with {}; take the loss acceptance "
        "or energy:K, or the family fg_chin",
        family.name, family.letters.has_own_letters() ? "a letter of its own that is not" : "the letter D"));
  }
  const coordinates which = coordinates_of(system, options, other == nullptr && kind.is_of_energy_norm);
  const auto measure = std::make_shared<const metric>(system, data, which);
  // What rivals of other steps are compared on, which are none in a bath and of words with a processor.
  const bool has_other_steps = family.letters.stochastic_letters == 0 && !family.letters.is_processed() &&
                               !family.letters.has_own_letters();
  const auto kept = has_other_steps ? std::make_shared<const flow_map_data>(held_out) : nullptr;
  return make_problem(
      {family, system, data, held_out, chosen, other, which, measure, options.threads, in_lanes, kept},
      options);
}

fit learn(const run_time_family& family, const model& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options, const other_loss* other) {
  require_valid(data, system);
  if (options.check_force) require_sound_force(system, data);
  return solve(make_learning_problem(family, system, data, held_out, options, other));
}

}  // namespace detail

}  // namespace nysalt
