// SPDX-License-Identifier: BSL-1.0
// From a family, a system and its data to a problem of learning.

#include "problem.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "data_of_problem.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/stepping/served_letters.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

namespace {

/// Whether a change to modes costs a pass over the coordinates, and no product with a full matrix.
bool has_cheap_modes(const model& system) {
  if (!has_modes(system)) return false;
  const auto each = std::ssize(detail::modal_coordinates::of(system)->entries()) / size(system);
  return each <= detail::most_for_all_frequencies;
}

/// The coordinates that were asked for; else the energy coordinates where the loss is of them and they are
/// cheap, else qp.
coordinates coordinates_of(const model& system, const fit_options& options, const loss_kind& kind) {
  if (options.coordinates) return *options.coordinates;
  return kind.is_of_energy_norm && has_cheap_modes(system) ? coordinates::energy : coordinates::qp;
}

/// The loss of the options, or the usual one, where the family and the data can be fitted by it.
loss_choice sound_choice(const family& family, const model& system, const flow_map_data& data,
                         const flow_map_data& held_out, const fit_options& options) {
  require_valid(data, system);
  require_valid(held_out, system);
  require_served_with_slopes(family.letters, system, system.facts().in_lanes_with_slopes);
  if (held_out.step != data.step) {
    throw std::invalid_argument(fmt::format(
        "learn: data and held-out data must have the same step, got {} and {}", data.step, held_out.step));
  }
  if (&held_out.share().ranks() != &data.share().ranks()) {
    throw std::invalid_argument("learn: the data and the held-out data must be shared by the same ranks");
  }
  loss_choice chosen = options.loss.value_or(usual_loss(system.bath()));
  if (!family.letters.is_symplectic && !chosen.kind->is_for_sampling) {
    throw std::invalid_argument(fmt::format(
        "learn: the family must be symplectic except for sampling, got {} with {}; take the loss acceptance "
        "or energy:K, or the family fg_chin",
        family.name, family.letters.has_own_letters() ? "a letter of its own that is not" : "the letter D"));
  }
  return chosen;
}

/// The steps of the shortest trajectory of both.
int whole_steps(const flow_map_data& data, const flow_map_data& held_out) {
  return std::min(detail::shortest_of(data), detail::shortest_of(held_out));
}

double frequency_known(const model& system, const fit_options& options) {
  if (options.frequency) return *options.frequency;
  return has_modes(system) ? frequency_to_fit(system) : 0.0;
}

fit_options within_proposals(fit_options options, const loss_kind& kind, int shortest) {
  if (kind.is_of_proposals) options.planned_steps = std::min<std::int64_t>(options.planned_steps, shortest);
  return options;
}

/// The guard that knows the frequencies along both sets of data.
detail::stability_guard guard_along(const learning_problem& problem) {
  auto [states, typical] = some_states(problem.system, problem.data);
  states.append(some_states(problem.system, problem.held_out).states);
  // Over ten thousand steps, as at first: what grows more slowly a trial run shows.
  constexpr std::int64_t most_steps = 10'000;
  return {problem.system, states, problem.family.letters, std::min(problem.options.planned_steps, most_steps),
          typical};
}

}  // namespace

void require_served_with_slopes(const word& letters, const model& system, bool in_lanes) {
  require_served<model, double>(letters, system);
  if (in_lanes) {
    require_served<model, detail::lanes_with_slopes>(letters, system);
  } else {
    require_served<model, dual<double, detail::directions_at_a_time>>(letters, system);
  }
}

/// Judges of steps, made when they are first asked, and what they said.
struct learning_problem::judges {
  explicit judges(phase_points from) : starts(std::move(from)) {}

  struct known {
    std::string letters;
    std::vector<double> coefficients;
    double step;
    judgement found;
  };

  phase_points starts;
  std::map<double, step_judge> of_step{};
  std::vector<std::unique_ptr<const known>> said{};
};

learning_problem::learning_problem(const nysalt::family& to_fit, const model& of_system,
                                   const flow_map_data& to_learn_from, const flow_map_data& to_judge_by,
                                   const fit_options& how)
    : family(to_fit),
      system(of_system),
      data(to_learn_from),
      held_out(to_judge_by),
      chosen(sound_choice(family, system, data, held_out, how)),
      options(within_proposals(how, *chosen.kind, whole_steps(data, held_out))),
      which(coordinates_of(system, options, *chosen.kind)),
      measure(std::make_shared<const metric>(system, data, which)),
      guard(guard_along(*this)),
      known_frequency(frequency_known(system, options)),
      whole_(whole_steps(data, held_out)),
      steps_(whole_),
      judges_(std::make_shared<judges>(judged_starts_of(system, data, held_out))) {
  tell_facts();
  one_step_over_held_out = counted(*loss_named("state").kind, held_out, {});
  const int end = detail::shortest_of(held_out);
  at_end_of_held_out = counted(*loss_named("state").kind, held_out, {.steps = {end}, .apart = end});
  make_losses();
}

void learning_problem::tell_facts() {
  facts.family = family.name;
  facts.system = data.system;
  facts.reference = data.reference;
  facts.ensemble = data.ensemble;
  facts.coordinates = to_string(which);
  facts.loss_name = chosen.description();
  facts.is_of_data = chosen.kind->asks_data();
  facts.derivatives = system.facts().derivative_source;
  facts.step = data.step;
  facts.seed = data.seed;
  facts.held_out_seed = held_out.seed;
  facts.held_out_is_new = !detail::begin_alike(data, held_out);
  facts.guard = guard.description();
  facts.coordinates_used = measure->residuals();
  facts.dropped = measure->dropped();
  facts.samples = data.all_pairs();
  facts.trajectories = static_cast<std::size_t>(data.share().total());
  facts.held_out_samples = held_out.all_pairs();
  facts.reference_checked = data.share().ranks().sum(std::ssize(data.finer)) > 0;
  if (facts.reference_checked) facts.reference_error = detail::error_of_reference(data, *measure);
  facts.data_seconds = data.seconds + held_out.seconds;
  if (chosen.kind->is_shortened) facts.trajectory_steps = whole_;
}

shared_loss learning_problem::made(const loss_kind& kind, const flow_map_data& pairs,
                                   after_steps_options how) const {
  how.execution = {.threads = options.execution.threads};
  return kind.over_data({family, system, pairs, *measure, std::move(how), in_lanes()});
}

shared_loss learning_problem::counted(const loss_kind& kind, const flow_map_data& pairs,
                                      const after_steps_options& how) {
  counted_.push_back(made(kind, pairs, how));
  return counted_.back();
}

objective learning_problem::watched(objective of_theta) const {
  const progress_callback& progress = options.execution.progress;
  if (!progress) return of_theta;
  return [of_theta = std::move(of_theta), progress, passes = passes_](const Eigen::VectorXd& theta) {
    progress((*passes)++);
    return of_theta(theta);
  };
}

void learning_problem::make_losses() {
  const loss_kind& kind = *chosen.kind;
  const auto all = kind.stages(chosen.steps, steps_);
  times = all.back();
  facts.loss_steps = times.steps.back();
  over_held_out = counted(kind, held_out, times);
  stages.clear();
  one_step_before = {};
  if (!kind.asks_data()) {  // the loss judges, too
    law_ = kind.without_data(system, family, data.step);
    loss = watched(law_);
    if (kind.is_of_proposals) stages = {{.loss = loss}};  // from many starts: a pass costs little
    return;
  }
  const int every = detail::trajectories_apart(data, size(system));
  for (const auto& stage : all) add_stage(stage, every);
  if (!over_data) over_data = counted(kind, data, times);
  loss = watched([over = over_data](const Eigen::VectorXd& theta) { return over->at(theta); });
  if (!kind.is_shortened) return;
  motion_ = detail::motion_in(data, *measure, times);
  // The error of a fast coordinate of small amplitude is relative to its own motion, as it is not followed
  // where only slow ones are; in the energy norm that of all is relative to that of all.
  if (which == coordinates::energy) motion_.setConstant(motion_.mean());
  if (!has_shorter()) return;
  const auto one_step = counted(kind, data, {.steps = {1}, .apart = std::max(whole_ / 8, 1), .every = every});
  one_step_before = [one_step](const Eigen::VectorXd& theta) { return one_step->at(theta); };
}

void learning_problem::add_stage(const after_steps_options& stage, int every) {
  after_steps_options few = stage;
  few.every = every;
  if (chosen.kind->is_shortened) few.apart = std::max(stage.apart, whole_ / 2);  // two windows a trajectory
  const auto over = counted(*chosen.kind, data, few);
  const bool has_all = every == 1 && few.apart == stage.apart;
  stages.push_back({.loss = watched([over](const Eigen::VectorXd& theta) { return over->at(theta); }),
                    .steps = stage.steps.back()});
  constexpr double lost = 0.25;  // an error of half the motion
  if (has_shorter()) stages.back().lost_above = lost * detail::motion_in(data, *measure, stage).sum();
  over_data = has_all ? over : nullptr;
}

learning_problem learning_problem::shorter() const {
  learning_problem result = *this;
  result.steps_ = steps_ / 4 + 1;
  result.make_losses();
  return result;
}

double learning_problem::judge(const Eigen::VectorXd& theta) const {
  if (law_) return law_(theta).value;
  switch (chosen.kind->judge) {
    case loss_kind::judge_of_minima::held_out_end:
      return at_end_of_held_out->value(theta);
    case loss_kind::judge_of_minima::training_loss:
      return over_data->value(theta);
    case loss_kind::judge_of_minima::held_out_loss:
      break;
  }
  return over_held_out->value(theta);
}

trajectory_scores learning_problem::scores(const Eigen::VectorXd& theta) const {
  return scores_of(*over_data, theta, measure->weight_deviations());
}

trajectory_scores learning_problem::held_out_scores(const Eigen::VectorXd& theta) const {
  if (!facts.held_out_is_new) return {std::vector<Eigen::VectorXd>{}};
  return scores_of(*over_held_out, theta, measure->weight_deviations(held_out));
}

bool learning_problem::follows(const Eigen::VectorXd& theta) const {
  if (motion_.size() == 0) return true;
  constexpr double lost = 0.05 * 0.05;
  const Eigen::VectorXd squares = over_data->by_residual(theta);  // those of a time after those of another
  double relative = 0.0;
  for (Eigen::Index k = 0; k < squares.size(); ++k) relative += squares[k] / motion_[k % motion_.size()];
  return relative <= lost * static_cast<double>(motion_.size());
}

method learning_problem::member(const Eigen::VectorXd& theta) const {
  return {family.name, family.letters, family.coefficients(theta), {1, false, false}};
}

const judgement& learning_problem::judged(const method& method, double step) const {
  const std::string& letters = method.letters().letters();
  const auto coefficients = method.coefficients();
  for (const auto& known : judges_->said) {
    if (known->step == step && known->letters == letters && known->coefficients == coefficients)
      return known->found;
  }
  auto judge = judges_->of_step.find(step);
  if (judge == judges_->of_step.end()) {
    const judging_options how{.steps = options.planned_steps,
                              .execution = {.threads = options.execution.threads},
                              .watches_energy = !chosen.kind->is_of_proposals};
    judge = judges_->of_step.emplace(step, step_judge(system, judges_->starts, step, how)).first;
  }
  judges_->said.push_back(std::make_unique<const judges::known>(
      judges::known{letters, coefficients, step, judge->second.of(method)}));
  return judges_->said.back()->found;
}

std::int64_t learning_problem::evaluations() const {
  std::int64_t here = 0;
  for (const auto& one : counted_) here += one->evaluations();
  return data.evaluations + held_out.evaluations + data.share().ranks().sum(here);
}

namespace detail {

fit_options with_loss(fit_options options, loss_choice loss) {
  if (options.loss) {
    throw std::invalid_argument(
        fmt::format("learn: the loss must be one, got {} and {}; leave the loss of the options away",
                    options.loss->description(), loss.description()));
  }
  options.loss = std::move(loss);
  return options;
}

}  // namespace detail

namespace {

/// Tries the letters of the system in a word at a state of each quarter of the data.
void require_sound_letters_on(const model& system, const word& letters, const flow_map_data& data) {
  constexpr Eigen::Index most = 2000;  // coordinates: the Jacobian of a letter has 4 times their square
  if (!letters.has_own_letters() || size(system) > most) return;
  std::vector<phase_point<double, Eigen::Dynamic>> points;
  const std::size_t pairs = data.start.size();
  for (std::size_t quarter = 0; quarter < 4 && pairs > 0; ++quarter) {
    points.push_back(data.start[(2 * quarter + 1) * pairs / 8]);
  }
  if (!points.empty()) detail::require_sound_letters(system, letters, points, data.step);
}

}  // namespace

fit learn(const family& family, const model& system, const flow_map_data& data, const flow_map_data& held_out,
          const fit_options& options) {
  require_valid(data, system);
  if (options.check_force) {
    require_sound_force(system, data);
    require_sound_letters_on(system, family.letters, data);
  }
  return solve({family, system, data, held_out, options});
}

}  // namespace nysalt
