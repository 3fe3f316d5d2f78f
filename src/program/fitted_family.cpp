// SPDX-License-Identifier: BSL-1.0
#include "fitted_family.hpp"
#include "systems.hpp"

#include <algorithm>
#include <cmath>

#include "comparison/checks.hpp"
#include "comparison/learning.hpp"
#include "comparison/method_file.hpp"
#include "comparison/method_source.hpp"
#include "comparison/progress.hpp"
#include "comparison/purpose.hpp"
#include "nysalt/losses/loss_choice.hpp"

namespace nysalt::program {

namespace {

/// With --enough: from fewer its own estimate is too rough.
constexpr std::int64_t first_trajectories = 50;

std::vector<double> steps_of(const learn_command& command) {
  if (command.step.has_value() == !command.steps.empty()) {
    refuse("learn: {} or {} must be given, and not both; give {} for a curve", spelled("step"),
           spelled("steps"), spelled("steps"));
  }
  std::vector<double> steps = command.steps;
  if (command.step) steps.push_back(*command.step);
  for (const double step : steps) {
    require_positive(command.step ? "step" : "steps", step);
    steps_within("horizon", command.learning.horizon_at(step), step);
  }
  require_different("steps", steps, [](double one, double next) { return next - one <= 1e-8 * one; });
  return steps;
}

json document_of(const learned_scheme& learned, const prepared_problem& system,
                 const std::optional<rival_judgement>& rival, std::optional<placement> where,
                 const std::string& purpose) {
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
  result["loses_fewest"] = to_json(rival);
  result["frequency"] = nullptr;
  if (fit.fitted_frequency > 0.0)
    result["frequency"] = {{"value", fit.fitted_frequency}, {"source", fit.source_of_frequency}};
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
  result["purpose"] = purpose.empty() ? json(nullptr) : json(purpose);
  return result;
}

}  // namespace

fitted_family::fitted_family(const learn_command& command, const common_settings& common)
    : command_(command), common_(common), system_(make_system(command.system)) {
  settle_purpose(command_.learning, system_->heat_bath(), "");
  require_sound(command_.learning, "");
  steps_ = steps_of(command_);
  if (command.enough) {
    require_positive("enough", *command.enough);
    const loss_kind& loss = *loss_named(command_.learning.loss).kind;
    if (!loss.asks_data()) {
      refuse_value("enough", "must come with a loss that learns from trajectories, got {}; leave {} out",
                   loss.name, spelled("enough"));
    }
  }
  method_source source;
  source.typed = source.family.emplace(command.family);
  const auto where = placement_in(source, *system_, placement_asked(command.placement));
  plan_ = plan_for(command.family, where, steps_.front(), command_.learning, common);
  if (command.enough) {
    plan_.enough = enough_options{.share = *command.enough};
    plan_.how.trajectories = first_trajectories;
  }
  for (const double step : steps_) system_->require_learnable(plan_.family, plan_.where, plan_.how, step);
}

void fitted_family::learn() {
  progress shown;
  prepare_starts(*system_, common_, shown, warnings_);
  learned_ = learn_curve(*system_, plan_, steps_, shown);
  shown.part("judging the step");
  for (const auto& one : learned_)
    losing_fewest_.push_back(
        loses_fewest(one.method, *system_, one.fit.judgement, common_.execution.threads));
  for (const auto& one : learned_) {
    if (one.course && !one.course->is_reached)
      warnings_.push_back(fmt::format("at step {:g} {}", one.fit.step, one.course->report()));
  }
}

const learned_scheme* fitted_family::unusable() const {
  const auto bad = std::ranges::find_if(learned_, [](const auto& one) { return !one.fit.usable; });
  return bad == learned_.end() ? nullptr : &*bad;
}

json fitted_family::document() const {
  json fits = json::array();
  for (std::size_t k = 0; k < learned_.size(); ++k) {
    fits.push_back(document_of(learned_[k], *system_, losing_fewest_[k], plan_.where, purpose()));
  }
  json result = command_.step ? fits.front() : json{{"fits", fits}};
  result["warnings"] = warnings_;
  return result;
}

json fitted_family::scheme() const { return scheme_document(learned_, *system_, plan_); }

}  // namespace nysalt::program
