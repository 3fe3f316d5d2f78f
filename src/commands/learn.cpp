// SPDX-License-Identifier: BSL-1.0
#include "../bundled_system.hpp"
#include "../checks.hpp"
#include "../commands.hpp"
#include "../learning.hpp"
#include "../method_file.hpp"
#include "../method_source.hpp"
#include "../output.hpp"
#include "../progress.hpp"

namespace nysalt::program {

namespace {

json document(const learned_scheme& learned, const bundled_system& system, std::optional<placement> where) {
  const fit_summary& fit = learned.fit;
  json result = fit_json(fit);
  result["system"] = system.description();
  result["coordinates"] = fit.coordinates;
  result["held_out_samples"] = fit.held_out_samples;
  result["trajectories"] = fit.trajectories;
  result["one_step_error"] = fit.one_step_error;
  result["reference"] = fit.reference;
  result["reference_error"] = fit.reference_checked ? json(fit.reference_error) : json(nullptr);
  result["condition"] = fit.condition;
  result["flat_directions"] = fit.flat_directions;
  result["dropped_coordinates"] = fit.dropped;
  result["iterations"] = fit.iterations;
  result["starts"] = fit.ensemble;
  result["energy_range"] =
      learned.energies ? json{learned.energies->low, learned.energies->high} : json(nullptr);
  result["seed"] = fit.seed;
  result["placement"] = where ? json(to_string(*where)) : json(nullptr);
  return result;
}

}  // namespace

int learn(const learn_command& command, const common_settings& common) {
  require_positive("--step", command.step);
  require_sound(command.learning, "--");
  steps_within("--horizon", command.learning.horizon, command.step);
  const auto system = make_system(command.system);
  if (!command.output.empty()) require_writable(command.output);

  progress shown;
  method_source source;
  source.typed = source.family.emplace(command.family);
  const auto where = placement_in(source, *system, placement_asked(command.placement));
  const learn_plan plan = plan_for(command.family, where, command.step, command.learning, common);
  system->require_learnable(plan.family, plan.where, plan.how, plan.step);
  prepare_starts(*system, common, shown);
  const learned_scheme learned = learn_with(*system, plan, shown);
  shown.clear();

  const fit_summary& fit = learned.fit;
  const bool keep = !command.output.empty() && (fit.usable || common.force);
  if (keep) write_result(command.output, scheme_text(learned, *system, plan), common);
  if (common.json) {
    json result = document(learned, *system, where);
    result["output"] = keep ? json(command.output) : json(nullptr);
    print(text_of(result));
  } else {
    print(fit.full());
    if (where)
      print(fmt::format("  {:<22}{}: {}\n", "letters O", to_string(*where),
                        learned.method.letters().letters()));
    if (keep) print(fmt::format("Written: {}\n", command.output));
  }
  if (fit.usable) return done;
  const bool withheld = !command.output.empty() && !keep;
  warn(fmt::format("the fit is not usable: {}{}", fit.reason,
                   withheld ? "; the scheme file was not written (--force writes it)" : ""));
  return no_result;
}

}  // namespace nysalt::program
