// SPDX-License-Identifier: BSL-1.0
#include "learning.hpp"

#include "catalogue.hpp"
#include "checks.hpp"
#include "seeds.hpp"

namespace nysalt::program {

void require_sound(const learn_settings& how, const std::string& prefix) {
  const std::string trajectories = prefix + "trajectories";
  const std::string horizon = prefix + "horizon";
  require_at_least_one(trajectories.c_str(), how.trajectories);
  require_positive(horizon.c_str(), how.horizon);
  if (how.fine_step) require_positive("--fine-step", *how.fine_step);
  coordinates_named(how.coordinates);
}

learned_scheme learn_with(const bundled_system& system, const learn_plan& plan, progress& shown) {
  system.require_learnable(plan.family, plan.where, plan.how, plan.step);
  shown.part(fmt::format("learning {} at step {:g}", plan.family, plan.step));
  return system.learn(plan, shown.counter(plan.how.trajectories));
}

learn_plan plan_for(const std::string& family, std::optional<placement> where, double step,
                    const learn_settings& how, const common_settings& common) {
  return {.family = family,
          .where = where,
          .step = step,
          .how = how,
          .seed = seed_for(role::training, common.seed),
          .held_out_seed = seed_for(role::held_out, common.seed),
          .threads = common.threads};
}

void prepare_starts(bundled_system& system, const common_settings& common, progress& shown) {
  shown.part("preparing the starts");
  system.prepare_starts(seed_for(role::training, common.seed));
}

json by_name(const fit_summary& fit, double fitted_parameter::*field) {
  json result = json::object();
  for (const auto& parameter : fit.parameters) result[parameter.name] = parameter.*field;
  return result;
}

json fit_json(const fit_summary& fit) {
  return {{"family", fit.family},
          {"parameters", by_name(fit, &fitted_parameter::value)},
          {"standard_errors", by_name(fit, &fitted_parameter::standard_error)},
          {"step", fit.step},
          {"loss", fit.loss},
          {"held_out_loss", fit.held_out_loss},
          {"samples", fit.samples},
          {"usable", fit.usable},
          {"reason", fit.usable ? json(nullptr) : json(fit.reason)},
          {"seconds", fit.data_seconds + fit.fit_seconds},
          {"data_seconds", fit.data_seconds},
          {"fit_seconds", fit.fit_seconds},
          {"learning_evaluations", fit.learning_evaluations}};
}

}  // namespace nysalt::program
