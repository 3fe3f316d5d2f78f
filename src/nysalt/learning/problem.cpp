// SPDX-License-Identifier: BSL-1.0

#include "nysalt/learning/problem.hpp"
#include "data_of_problem.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nysalt/communicator.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/learning/reach.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/tabulated.hpp"

namespace nysalt::detail {

bool begin_alike(const flow_map_data& a, const flow_map_data& b) {
  const communicator& ranks = a.share().ranks();
  bool result = false;
  if (ranks.is_first()) {
    const bool other_noise = a.noise_parts > 0 && a.noise_parts == b.noise_parts && a.noise[0] != b.noise[0];
    result = a.start[0].q == b.start[0].q && a.start[0].p == b.start[0].p && !other_noise;
  }
  broadcast(ranks, result);
  return result;
}

double error_of_reference(const flow_map_data& data, const metric& measure) {
  std::vector<double> squares(data.trajectories(), 0.0);
  Eigen::VectorXd r(measure.residuals());
  for (const auto& [pair, finish] : data.finer) {
    double& of_trajectory = squares[data.trajectory_of(pair)];
    measure.residual(finish.q, finish.p, data.finish[pair], r.data());
    for (const double x : r) of_trajectory += x * x;
  }
  const auto checks = data.share().ranks().sum(std::ssize(data.finer));
  const double difference = std::sqrt(data.share().sum(squares) / static_cast<double>(checks));
  return data.noise_parts > 0 ? error_over_difference * difference : difference;
}

int shortest_of(const flow_map_data& data) {
  std::size_t least = data.all_pairs();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    least = std::min(least, data.first_of[m + 1] - data.first_of[m]);
  }
  const auto of_all = data.share().ranks().minimum(static_cast<std::int64_t>(least));
  return static_cast<int>(std::max<std::int64_t>(of_all, 1));
}

Eigen::VectorXd motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how) {
  const auto last = static_cast<std::size_t>(how.steps.back());
  const window_starts starts(data, last, static_cast<std::size_t>(how.apart));
  const double terms =
      static_cast<double>(data.share().ranks().sum(std::ssize(starts.pairs)) * std::ssize(how.steps));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(measure.residuals());
  std::vector<Eigen::VectorXd> squares(data.trajectories(), zero);
  Eigen::VectorXd r = zero;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = starts.first_of[m]; n < starts.first_of[m + 1]; ++n) {
      const std::size_t first = starts.pairs[n];
      for (const int steps : how.steps) {
        const auto& finish = data.finish[first + static_cast<std::size_t>(steps) - 1];
        measure.residual(finish.q, finish.p, data.start[first], r.data());
        squares[m] += r.cwiseAbs2() / terms;
      }
    }
  }
  return data.share().sum(squares, zero);
}

int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates) {
  constexpr std::int64_t enough = 1200;  // coordinates of all trajectories
  constexpr std::int64_t least = 16;
  const std::int64_t all = data.share().total();
  return static_cast<int>(
      std::clamp<std::int64_t>(all * coordinates / enough, 1, std::max<std::int64_t>(all / least, 1)));
}

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

// Trajectories of data that go to other ranks.

namespace {

/// All doubles of trajectories begin .. end - 1 of this rank, by their places here: how many finer finishes
/// there are and of which of these pairs, then states and noise.
std::vector<double> packed(const flow_map_data& data, std::size_t begin, std::size_t end) {
  std::vector<double> numbers;
  const auto add = [&](const auto& values) { numbers.insert(numbers.end(), values.begin(), values.end()); };
  const auto add_state = [&](const auto& x) {
    add(x.q);
    add(x.p);
  };
  const std::size_t first = data.first_of[begin];
  const std::size_t last = data.first_of[end];
  numbers.push_back(static_cast<double>(end - begin));
  for (std::size_t m = begin; m < end; ++m) {
    numbers.push_back(static_cast<double>(data.first_of[m + 1] - data.first_of[m]));
  }
  const auto is_here = [&](const auto& finer_finish) {
    return first <= finer_finish.first && finer_finish.first < last;
  };
  numbers.push_back(static_cast<double>(std::ranges::count_if(data.finer, is_here)));
  for (const auto& finer_finish : data.finer) {
    if (!is_here(finer_finish)) continue;
    numbers.push_back(static_cast<double>(finer_finish.first - first));
    add_state(finer_finish.second);
  }
  const auto parts = static_cast<std::size_t>(data.noise_parts);
  for (std::size_t n = first; n < last; ++n) {
    add_state(data.start[n]);
    add_state(data.finish[n]);
    for (std::size_t k = 0; k < parts; ++k) add(data.noise[n * parts + k]);
  }
  return numbers;
}

/// Puts them behind those that there are.
void unpack(std::span<const double> numbers, Eigen::Index dimension, flow_map_data& data) {
  const auto take = [&] {
    const double x = numbers.front();
    numbers = numbers.subspan(1);
    return x;
  };
  const auto take_count = [&] { return static_cast<std::size_t>(take()); };
  const auto take_vector = [&] {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(numbers.data(), dimension);
    numbers = numbers.subspan(static_cast<std::size_t>(dimension));
    return x;
  };
  const auto take_state = [&] {
    phase_point<double, Eigen::Dynamic> x;
    x.q = take_vector();
    x.p = take_vector();
    return x;
  };
  const std::size_t first = data.pairs();
  const std::size_t trajectories = take_count();
  for (std::size_t m = 0; m < trajectories; ++m) data.first_of.push_back(data.first_of.back() + take_count());
  const std::size_t finer = take_count();
  for (std::size_t k = 0; k < finer; ++k) {
    const std::size_t pair = first + take_count();
    data.finer.emplace_back(pair, take_state());
  }
  while (data.pairs() < data.first_of.back()) {
    data.start.push_back(take_state());
    data.finish.push_back(take_state());
    for (int k = 0; k < data.noise_parts; ++k) data.noise.push_back(take_vector());
  }
}

}  // namespace

void redistribute(flow_map_data& data, const shard& next, Eigen::Index dimension) {
  const shard now = data.share();
  const communicator& ranks = next.ranks();
  if (ranks.is_single()) return;
  flow_map_data kept;
  kept.first_of = {0};
  kept.noise_parts = data.noise_parts;
  for (int from = 0; from < ranks.size(); ++from) {
    for (int to = 0; to < ranks.size(); ++to) {
      if (from != ranks.rank() && to != ranks.rank()) continue;
      const std::int64_t begin = std::max(now.first_of(from), next.first_of(to));
      const std::int64_t end = std::min(now.first_of(from + 1), next.first_of(to + 1));
      if (begin >= end) continue;
      std::vector<double> numbers;
      if (from == ranks.rank()) {
        const auto place = [&](std::int64_t m) { return static_cast<std::size_t>(m - now.first()); };
        numbers = packed(data, place(begin), place(end));
      }
      if (from != to) {
        auto length = static_cast<std::int64_t>(numbers.size());
        const std::span length_message(&length, 1);
        if (from == ranks.rank()) {
          ranks.send(std::as_bytes(length_message), to);
          ranks.send(std::as_bytes(std::span(numbers)), to);
          continue;
        }
        ranks.receive(std::as_writable_bytes(length_message), from);
        numbers.resize(static_cast<std::size_t>(length));
        ranks.receive(std::as_writable_bytes(std::span(numbers)), from);
      }
      unpack(numbers, dimension, kept);
    }
  }
  data.start = std::move(kept.start);
  data.finish = std::move(kept.finish);
  data.noise = std::move(kept.noise);
  data.first_of = std::move(kept.first_of);
  data.finer = std::move(kept.finer);
}

namespace {

/// Whether the errors at these times are below a twentieth of the motion, in the mean over coordinates: each
/// over its own motion, as a fast one of small amplitude is not followed where only slow ones are; in the
/// energy norm all over that of all.
std::function<bool(const Eigen::VectorXd&)> follows_over(const source_of_losses& from, const data_loss& loss,
                                                         const after_steps_options& times) {
  Eigen::VectorXd motion = motion_in(from.data, *from.measure, times);
  if (from.which == coordinates::energy) motion.setConstant(motion.mean());
  return [by_residual = loss.by_residual, motion](const Eigen::VectorXd& theta) {
    constexpr double lost = 0.05 * 0.05;
    const Eigen::VectorXd squares = by_residual(theta);  // those of a time after those of another
    double relative = 0.0;
    for (Eigen::Index k = 0; k < squares.size(); ++k) relative += squares[k] / motion[k % motion.size()];
    return relative <= lost * static_cast<double>(motion.size());
  };
}

}  // namespace

loss_by_times losses_by_times(const source_of_losses& from, const data_loss& held,
                              const after_steps_options& how) {
  struct lasting {
    run_time_family family;
    model system;
    std::optional<other_loss> other;
    std::map<int, std::shared_ptr<const data_loss>> known;
  };
  const auto kept = std::make_shared<lasting>(lasting{from.family, from.system, {}, {}});
  if (from.other != nullptr) kept->other = *from.other;
  kept->known[1] = std::make_shared<const data_loss>(held);
  return [kept, how, data = from.kept_held_out, chosen = from.chosen, which = from.which,
          measure = from.measure, threads = from.threads, in_lanes = from.in_lanes](int times) {
    if (const auto found = kept->known.find(times); found != kept->known.end()) return found->second;
    auto& result = kept->known[times];
    if (data == nullptr) return result;
    const auto longer = in_longer_steps(how, times, shortest_of(*data));
    if (longer.steps.empty()) return result;
    const flow_map_data pairs = coarser(*data, times);
    const source_of_losses again{
        kept->family, kept->system, pairs,   pairs,   chosen, kept->other ? &*kept->other : nullptr,
        which,        measure,      threads, in_lanes};
    result = std::make_shared<const data_loss>(again.over(pairs, longer));
    return result;
  };
}

void put_losses(learning_problem& problem, const source_of_losses& from, const rivals_by& rival,
                const data_loss& at_end, int most_steps, const std::function<std::int64_t()>& before) {
  const flow_map_data& data = from.data;
  const loss_kind& kind = *from.chosen.kind;
  const int whole = std::min(shortest_of(data), shortest_of(from.held_out));
  const int shortest = std::min(whole, most_steps);
  const auto stages = from.other == nullptr ? kind.stages(from.chosen.steps, shortest)
                                            : after_each_step(from.other->steps, shortest);
  std::vector<data_loss> losses_of_stages;
  const int every = trajectories_apart(data, size(from.system));
  const bool is_of_trajectories = from.other == nullptr && kind.is_shortened;
  const bool has_several_steps = is_of_trajectories && shortest > 1;
  bool has_all = false;  // the last stage
  for (auto stage : stages) {
    // Two windows a trajectory show where minima lie.
    const int apart = is_of_trajectories ? std::max(stage.apart, whole / 2) : stage.apart;
    has_all = every == 1 && apart == stage.apart;
    stage.every = every;
    stage.apart = apart;
    losses_of_stages.push_back(from.over(data, stage));
  }
  const data_loss loss = has_all ? losses_of_stages.back() : from.over(data, stages.back());
  std::optional<data_loss> one_step_before;
  if (has_several_steps) {
    one_step_before = from.over(data, {.steps = {1}, .apart = std::max(whole / 8, 1), .every = every});
  }
  const auto held = from.over(from.held_out, stages.back());
  const auto passes = [=] {
    std::int64_t here = held.evaluations() + before();
    for (const auto& stage : losses_of_stages) here += stage.evaluations();
    if (!has_all) here += loss.evaluations();
    if (one_step_before) here += one_step_before->evaluations();
    return here;
  };
  const learning_problem without = problem;
  problem.loss = loss.of_theta;
  problem.scores = [of = loss.scores, measure = from.measure](const Eigen::VectorXd& theta) {
    return of(theta, measure->weight_deviations());
  };
  problem.held_out_scores = {};
  if (problem.facts.held_out_is_new) {
    const auto deviations = from.measure->weight_deviations(from.held_out);
    problem.held_out_scores = [of = held.scores, deviations](const Eigen::VectorXd& theta) {
      return of(theta, deviations);
    };
  }
  problem.held_out_losses = held.by_trajectory;
  const auto judge = from.other == nullptr ? kind.judge : judge_of_minima::held_out_loss;
  problem.judge = judge == judge_of_minima::held_out_end    ? at_end.value
                  : judge == judge_of_minima::training_loss ? loss.value
                                                            : held.value;
  const std::int64_t of_data = data.evaluations + from.held_out.evaluations;
  problem.evaluations = [&ranks = data.share().ranks(), of_data, passes] {
    return of_data + ranks.sum(passes());
  };
  problem.rival = [rival, by_times = losses_by_times(from, held, stages.back())](const tabulated& method) {
    return rival(method, by_times);
  };
  problem.facts.loss_steps = stages.back().steps.back();
  for (std::size_t n = 0; from.asks_data() && n < stages.size(); ++n) {
    problem.stages.push_back({.loss = losses_of_stages[n].of_theta, .steps = stages[n].steps.back()});
    if (!has_several_steps) continue;
    constexpr double lost = 0.25;  // an error of half the motion
    problem.stages.back().lost_above = lost * motion_in(data, *from.measure, stages[n]).sum();
  }
  if (!from.asks_data()) {  // the loss judges, too
    problem.loss = kind.without_data(from.system, from.family, data.step);
    problem.judge = [law = problem.loss](const Eigen::VectorXd& theta) { return law(theta).value; };
    if (kind.is_of_proposals)
      problem.stages = {{.loss = problem.loss}};  // from many starts: a pass costs little
  }
  if (!is_of_trajectories) return;
  problem.facts.trajectory_steps = whole;
  problem.follows = follows_over(from, loss, stages.back());
  if (!has_several_steps) return;
  problem.one_step_before = one_step_before->of_theta;
  problem.shorter = std::make_shared<learning_problem>(without);
  put_losses(*problem.shorter, from, rival, at_end, shortest / 4 + 1, passes);
}

}  // namespace nysalt::detail

// From a system, its data and a family to a problem that knows none of them.

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
  problem.is_of_black_box = is_black_box(system);
  problem.is_in_bath = system.bath().acts();
  if (options.frequency) {
    problem.frequency_to_fit = *options.frequency;
  } else if (has_modes(system)) {
    problem.frequency_to_fit = detail::frequency_to_fit(system);
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

namespace {

[[noreturn]] void refuse_size(const char* what, std::size_t n, Eigen::Index found, Eigen::Index wanted) {
  throw std::invalid_argument(fmt::format(
      "{} {} of the data must have the dimension of the system, got {} for {}", what, n, found, wanted));
}

void require_valid_here(const flow_map_data& data, const model& system) {
  const auto number_of = [&](std::size_t pair) { return data.first_pair() + pair; };
  const auto trajectory_of = [&](std::size_t pair) {
    return static_cast<std::size_t>(data.share().first()) + data.trajectory_of(pair);
  };
  if (data.system != describe(system)) {
    throw std::invalid_argument(fmt::format("learn: the data must be of the system, got data of {} for {}",
                                            data.system, describe(system)));
  }
  const bool covers = !data.first_of.empty() && data.first_of.front() == 0 &&
                      data.first_of.back() == data.pairs() &&
                      std::is_sorted(data.first_of.begin(), data.first_of.end());
  if (data.all_pairs() == 0 || data.finish.size() != data.pairs() || !covers) {
    throw std::invalid_argument(
        fmt::format("learn: the data must be whole, got {} starts, {} finishes, {} trajectories",
                    data.pairs(), data.finish.size(), data.trajectories()));
  }
  if (data.noise_parts < 0 ||
      data.noise.size() != data.pairs() * static_cast<std::size_t>(data.noise_parts)) {
    throw std::invalid_argument(
        fmt::format("learn: the data must be whole, got {} pairs with noise in {} parts that hold {}",
                    data.pairs(), data.noise_parts, data.noise.size()));
  }
  if (data.step == 0.0 || !std::isfinite(data.step)) {
    throw std::invalid_argument(
        fmt::format("learn: the step of the data must be positive and finite, got {}", data.step));
  }
  for (std::size_t n = 0; n < data.noise.size(); ++n) {
    const auto noise = data.noise[n];
    if (noise.size() != size(system)) refuse_size("noise", n, noise.size(), size(system));
    for (Eigen::Index i = 0; i < noise.size(); ++i) {
      if (std::isfinite(noise[i])) continue;
      const std::size_t pair = n / static_cast<std::size_t>(data.noise_parts);
      throw std::invalid_argument(fmt::format(
          "learn: the data must be finite, got coordinate {} of noise {} = {}, in pair {} of trajectory {}",
          i + 1, n, noise[i], number_of(pair), trajectory_of(pair)));
    }
  }
  const auto require_sound = [&](const char* what, std::size_t pair, const auto& x) {
    if (x.q.size() != size(system)) refuse_size(what, pair, x.q.size(), size(system));
    if (x.p.size() != size(system)) refuse_size(what, pair, x.p.size(), size(system));
    if (is_finite(x)) return;
    throw std::invalid_argument(fmt::format(
        "learn: the {} of pair {} of the data, in trajectory {}, must be finite: {}", what, number_of(pair),
        trajectory_of(pair), detail::not_finite_in(phase_point<double, Eigen::Dynamic>(x))));
  };
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    require_sound("start", n, data.start[n]);
    require_sound("finish", n, data.finish[n]);
  }
  for (const auto& [pair, finish] : data.finer) {
    if (pair >= data.pairs()) {
      throw std::invalid_argument(fmt::format(
          "learn: the data must be whole, got a finer finish of pair {} of {}", pair, data.pairs()));
    }
    require_sound("finer finish", pair, finish);
  }
}

}  // namespace

void require_valid(const flow_map_data& data, const model& system) {
  collectively(data.share().ranks(), [&] { require_valid_here(data, system); });
}

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
      fmt::format("cannot learn on {}: {}; mend the system, or learn with check_force = false",
                  describe(system), found.report()));
}

// A test whether starts are outside of the energies that were learned on, or outside by chance.

double energies_outside::probability() const {
  const auto m = static_cast<double>(trajectories);
  const auto n = static_cast<double>(examined);
  double term = m * (m - 1.0) / ((m + n) * (m + n - 1.0));  // that none is
  double rest = 1.0;
  for (std::size_t j = 0; j < outside; ++j) {
    rest -= term;
    const auto k = static_cast<double>(j);
    term *= (n - k) / (k + 1.0) * (k + 2.0) / (m + n - k - 2.0);
  }
  return rest;
}

// The largest of M exponential energies, the widest that are allowed for, is H with E exp(-t H) = Gamma(1 +
// t) M!/ Gamma(M + 1 + t): one of n others is beyond t H with n times that probability, or less.
double energies_outside::far() const {
  if (trajectories < 2) return std::numeric_limits<double>::infinity();
  const double m = static_cast<double>(trajectories) + 1.0;
  const double n = static_cast<double>(examined);
  const auto is_likely = [&](double t) {
    return std::log(n / chance) + std::lgamma(1.0 + t) + std::lgamma(m) - std::lgamma(m + t) > 0.0;
  };
  double near = 1.0;
  double beyond = 1.0;
  while (is_likely(beyond)) beyond *= 2.0;
  for (int k = 0; k < 50; ++k) {  // to rounding
    const double middle = 0.5 * (near + beyond);
    (is_likely(middle) ? near : beyond) = middle;
  }
  return (seen.high - seen.low) * (beyond - 1.0);
}

std::string energies_outside::report() const {
  return fmt::format(
      "{} of {} starts have energies outside {:.6g} to {:.6g}, on which it was learned (they go from "
      "{:.6g} "
      "to {:.6g})",
      outside, examined, seen.low, seen.high, energies.low, energies.high);
}

}  // namespace nysalt

namespace nysalt::detail {

namespace {

/// What defects of z^2 are multiplied with to be those of the matrix itself, its four entries counted. Of a
/// kernel only the phase counts, which is the first: a processor does the rest.
Eigen::VectorXd weights_of_defects(Eigen::Index count, double z, bool is_kernel) {
  const double root = std::numbers::sqrt2;  // the half trace is of two entries, and so does the difference
  Eigen::VectorXd weights(4);
  weights << root * std::pow(z, 4), std::pow(z, 3), std::pow(z, 3), root * z * z;
  if (is_kernel) weights.tail(3).setZero();
  return weights.head(count);
}

}  // namespace

objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step) {
  constexpr int points_of_band = 4;
  std::vector<double> angles;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < points_of_band; ++k) {
      const double z = step * (low + (high - low) * (k + 1.0) / points_of_band);
      if (z > 0.0 && std::isfinite(z)) angles.push_back(z);
    }
  }
  if (angles.empty() || family.letters.rotates()) return {};
  return [family, angles](const Eigen::VectorXd& theta) {
    const Eigen::Index count = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    const auto coefficients = family.coefficients(theta);
    for (const double z : angles) {
      Eigen::VectorXd r = defect_of_rotation(family.letters, coefficients, family.symmetric, z * z);
      const Eigen::VectorXd weights = weights_of_defects(r.size(), z, family.letters.is_processed());
      r = r.cwiseProduct(weights);
      const Eigen::MatrixXd slopes = weights.asDiagonal() * jacobian_of_defect(family, theta, z * z);
      sum.value += r.squaredNorm();
      sum.half_gradient += slopes.transpose() * r;
      sum.normal_matrix += slopes.transpose() * slopes;
    }
    const double share = 1.0 / static_cast<double>(angles.size());
    return squares{share * sum.value, share * sum.half_gradient, share * sum.normal_matrix};
  };
}

}  // namespace nysalt::detail
