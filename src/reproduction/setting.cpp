// SPDX-License-Identifier: BSL-1.0
#include "setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparison/catalogue.hpp"
#include "comparison/checks.hpp"
#include "comparison/learning.hpp"
#include "comparison/method_source.hpp"
#include "comparison/seeds.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "program/settings.hpp"
#include "program/systems.hpp"

namespace nysalt::program::paper {

std::uint64_t setting::seed(std::uint64_t repetition) const {
  return (common.seed + repetition) % seed_limit;
}

namespace {
trajectories_plan plan_of(const setting& setup, double step, double horizon, std::int64_t count) {
  return {step, steps_within("horizon", horizon, step), count, seed_for(role::test, setup.seed()),
          setup.common.execution.threads};
}
}  // namespace

std::unique_ptr<prepared_problem> chain(double frequency, double spread) {
  system_settings asked;
  asked.name = "fpu";
  asked.parameters["omega"] = fmt::format("{}", frequency);
  asked.spread = spread;
  return make_system(asked);
}

const prepared_problem& setting::in_bath(const std::string& start) const {
  auto& system = baths_[start];
  if (system) return *system;
  system_settings asked;
  asked.name = "fpu";
  asked.bath = {.friction = 0.01, .sigma = 0.05, .temperature = {}};
  asked.start = start;
  system = make_system(asked);
  system->prepare_starts(seed_for(role::training, seed()));
  return *system;
}

const method& setting::learned_in_bath(const std::string& start, double gap, placement where) const {
  const std::tuple key{start, gap, where};
  const auto known = learned_.find(key);
  if (known != learned_.end()) return known->second;
  const learning_setup how{
      .trajectories = pick<std::int64_t>(512, 16), .horizon = 1.0, .where = where, .fine_step = gap_step};
  return learned_.emplace(key, learn_at(*this, in_bath(start), gap * gap_step, how).method).first->second;
}

std::unique_ptr<prepared_problem> soft_dominated_chain() {
  initial_value_problem problem = chain()->definition();
  problem.starts = fpu_law<3>::soft_dominated(fpu_chain<3>(omega));
  const std::vector<named_value> parameters{
      {"name", "fpu"}, {"pairs", 3}, {"omega", omega}, {"starts", "soft"}};
  return std::make_unique<prepared_problem>(std::move(problem), parameters,
                                            surroundings{bath::of_sigma(0.0, 0.0), start::law});
}

learning_setup usual_learning_setup(const setting& setup) {
  return {.trajectories = setup.pick<std::int64_t>(100, 10)};
}

learned_scheme learn_at(const setting& setup, const prepared_problem& system, double step,
                        const learning_setup& how) {
  const learn_plan plan{.family = "nystrom",
                        .where = how.where,
                        .step = step,
                        .how = {.fine_step = how.fine_step,
                                .trajectories = how.trajectories,
                                .horizon = how.horizon,
                                .coordinates = how.coordinates,
                                .fix = {},
                                .loss = "state:1",
                                .random_starts = 0},
                        .seed = seed_for(role::training, setup.seed(how.repetition)),
                        .held_out_seed = seed_for(role::held_out, setup.seed(how.repetition)),
                        .threads = setup.common.execution.threads};
  return system.learn(plan, {});
}

std::vector<estimate> theta_with_errors(const learned_scheme& learned) {
  std::vector<estimate> theta;
  for (const auto& p : learned.fit.parameters) theta.push_back({p.value, p.standard_error});
  return theta;
}

method classical(const std::string& name, const prepared_problem& system) {
  std::vector<std::string> warnings;
  return coefficients_at(find_method(name), system, 1e-3, true, placement::symmetric, warnings);
}

method two_stages(double b1, double beta1) { return family_member("nystrom", {b1, beta1}); }

double reference_step(double step, double frequency) {
  return step / std::ceil(step * frequency / 0.05 - 1e-9);
}

measured_errors errors_at(const setting& setup, const prepared_problem& system,
                          const std::vector<method>& methods, double step, const judged& how) {
  const auto fine = how.fine_step ? how.fine_step : system.fine_step_for_ranking(step);
  const errors_plan plan{.trajectories = plan_of(setup, step, how.horizon, how.trajectories),
                         .metrics = {{how.metric, how.observable}},
                         .fine_step = fine};
  const auto found = system.errors(methods, plan, {}).front();
  return {found.methods, found.reference_error ? found.reference_error->mean : 0.0};
}

estimate error_of(const method_error& method) {
  const auto all = static_cast<std::int64_t>(method.of_each.size());
  if (2 * method.diverged > all) return {std::numeric_limits<double>::infinity(), 0.0};
  return method.error;
}

std::vector<record> followed(const setting& setup, const prepared_problem& system, const method& method,
                             double step, double horizon, double sample, std::int64_t trajectories,
                             const std::vector<std::string>& observables) {
  std::vector<record> all;
  const auto keep = [&](std::int64_t, const record& one) { all.push_back(one); };
  const trajectories_plan plan = plan_of(setup, step, horizon, trajectories);
  run(system, method, {plan, observables, std::llround(sample / step)}, keep, {});
  return all;
}

}  // namespace nysalt::program::paper
