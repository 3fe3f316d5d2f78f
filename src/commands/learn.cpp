// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <cmath>

#include "../bundled_system.hpp"
#include "../checks.hpp"
#include "../commands.hpp"
#include "../learning.hpp"
#include "../method_file.hpp"
#include "../method_source.hpp"
#include "../output.hpp"
#include "../progress.hpp"
#include "../world.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/together.hpp"

namespace nysalt::program {

namespace {

/// With --enough: from fewer its own estimate is too rough.
constexpr std::int64_t first_trajectories = 50;

json document(const learned_scheme& learned, const bundled_system& system, std::optional<placement> where) {
  const fit_summary& fit = learned.fit;
  json result = fit_json(fit);
  result["system"] = system.description();
  result["coordinates"] = fit.coordinates;
  result["held_out_samples"] = fit.held_out_samples;
  result["trajectories"] = fit.trajectories;
  result["reference"] = fit.reference;
  result["reference_error"] = fit.reference_checked ? json(fit.reference_error) : json(nullptr);
  result["condition"] = fit.condition;
  result["flat_directions"] = fit.flat_directions;
  result["dropped_coordinates"] = fit.dropped;
  result["iterations"] = fit.iterations;
  result["starts_tried"] = fit.starts_tried;
  result["in_valley"] = fit.is_in_valley;
  result["guard"] = fit.guard;
  result["held_by_guard"] = fit.is_held_by_guard;
  result["unguarded"] = fit.unguarded.empty() ? json(nullptr) : json(fit.unguarded);
  result["gaps"] = json::array();
  for (const auto& [low, high] : fit.gaps) result["gaps"].push_back({low, high});
  result["starts"] = fit.ensemble;
  result["enough"] = nullptr;
  if (learned.course) {
    json stops = json::array();
    for (const auto& [trajectories, share, deciding] : learned.course->stops) {
      stops.push_back(
          {{"trajectories", trajectories}, {"excess_share", share}, {"deciding_trajectories", deciding}});
    }
    result["enough"] = {{"reached", learned.course->is_reached}, {"stops", stops}};
  }
  result["energy_range"] =
      learned.energies ? json{learned.energies->low, learned.energies->high} : json(nullptr);
  result["seed"] = fit.seed;
  result["placement"] = where ? json(to_string(*where)) : json(nullptr);
  return result;
}

}  // namespace

int learn(const learn_command& command, const common_settings& common) {
  if (command.step.has_value() == !command.steps.empty()) {
    refuse("give --step, or --steps for a curve, and not both");
  }
  std::vector<double> steps = command.steps;
  if (command.step) steps.push_back(*command.step);
  for (const double step : steps) {
    require_positive(command.step ? "--step" : "--steps", step);
    steps_within("--horizon", command.learning.horizon, step);
    const auto is_same = [&](double other) { return std::abs(other - step) <= 1e-8 * step; };
    if (std::count_if(steps.begin(), steps.end(), is_same) > 1) refuse("--steps names {} twice", step);
  }
  require_sound(command.learning, "--");
  if (command.enough) {
    require_positive("--enough", *command.enough);
    if (loss_named(command.learning.loss).of == loss_choice::kind::covariance) {
      refuse("--enough says how many trajectories to learn from, and the covariance loss asks none");
    }
  }
  const auto system = make_system(command.system);
  on_first(world(), [&] {
    if (!command.output.empty()) require_writable(command.output);
  });

  progress shown;
  method_source source;
  source.typed = source.family.emplace(command.family);
  const auto where = placement_in(source, *system, placement_asked(command.placement));
  learn_plan plan = plan_for(command.family, where, steps.front(), command.learning, common);
  if (command.enough) {
    plan.enough = enough_options{.share = *command.enough};
    plan.how.trajectories = first_trajectories;
  }
  for (const double step : steps) system->require_learnable(plan.family, plan.where, plan.how, step);
  prepare_starts(*system, common, shown);
  const auto learned = learn_curve(*system, plan, steps, shown);
  shown.clear();

  const auto bad =
      std::find_if(learned.begin(), learned.end(), [](const auto& one) { return !one.fit.usable; });
  const bool usable = bad == learned.end();
  const bool keep = !command.output.empty() && (usable || common.force);
  on_first(world(), [&] {
    if (keep) write_result(command.output, scheme_text(learned, *system, plan), common);
  });
  if (common.json) {
    json result;
    if (command.step) {
      result = document(learned.front(), *system, where);
    } else {
      result["fits"] = json::array();
      for (const auto& one : learned) result["fits"].push_back(document(one, *system, where));
    }
    result["output"] = keep ? json(command.output) : json(nullptr);
    print(text_of(result));
  } else {
    for (const auto& one : learned) {
      print(command.step ? one.fit.full() : one.fit.brief() + "\n");
      if (one.course && command.step) print(fmt::format("  {:<22}{}\n", "enough", one.course->report()));
    }
    if (where)
      print(fmt::format("  {:<22}{}: {}\n", "letters O", to_string(*where),
                        learned.front().method.letters().letters()));
    if (keep) print(fmt::format("Written: {}\n", command.output));
  }
  if (!common.json) {
    for (const auto& one : learned) {
      if (!one.course || one.course->is_reached) continue;
      warn(fmt::format("at step {:g} {}", one.fit.step, one.course->report()));
    }
  }
  if (usable) return done;
  const bool withheld = !command.output.empty() && !keep;
  warn(fmt::format("the fit at step {} is not usable: {}{}", bad->fit.step, bad->fit.reason,
                   withheld ? "; the scheme file was not written (--force writes it)" : ""));
  return no_result;
}

}  // namespace nysalt::program
