// SPDX-License-Identifier: BSL-1.0
#include "learning.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "all_ranks.hpp"
#include "catalogue.hpp"
#include "checks.hpp"
#include "judging.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "seeds.hpp"

namespace nysalt {

double learning_options::horizon_at(double step) const {
  if (horizon) return *horizon;
  const loss_choice chosen = loss.empty() ? loss_choice{} : loss_named(loss);
  if (chosen.kind->stages == detail::after_each_step) return std::max(0.5, 10.0 * step);
  constexpr double steps = 200.0;  // of more the mean error says no more, and in chaos less
  return steps * step;
}

}  // namespace nysalt

namespace nysalt::program {

void require_sound(const learning_options& how, const std::string& prefix) {
  require_at_least_one(prefix + "trajectories", how.trajectories);
  if (how.horizon) require_positive(prefix + "horizon", *how.horizon);
  if (how.fine_step) require_positive("fine_step", *how.fine_step);
  if (!how.coordinates.empty()) coordinates_named(how.coordinates);
  effort_named(how.effort);
  if (!how.loss.empty()) loss_named(how.loss);
  if (how.random_starts && (*how.random_starts < 0 || *how.random_starts > 10'000)) {
    refuse_value(prefix + "random_starts", "must be from 0 to 10000, got {}", *how.random_starts);
  }
}

namespace {

/// Each time as many trajectories more; those that there were are kept.
learned_scheme learn_enough(const prepared_problem& system, learn_plan plan, progress& shown) {
  std::optional<learned_scheme> learned;
  plan.kept = std::make_shared<std::any>();
  enough_options enough = *plan.enough;
  enough.most = std::min(enough.most, system.most_trajectories(plan));
  const auto learn = [&](std::int64_t trajectories) {
    plan.how.trajectories = trajectories;
    shown.part(
        fmt::format("learning {} at step {:g} from {} trajectories", plan.family, plan.step, trajectories));
    learned.emplace(system.learn(plan, shown.counter(trajectories)));
    return learned->fit;
  };
  const auto course = detail::until_enough(plan.how.trajectories, enough, learn);
  learned->course = course;
  return *learned;
}

}  // namespace

learned_scheme learn_with(const prepared_problem& system, const learn_plan& plan, progress& shown,
                          double work) {
  system.require_learnable(plan.family, plan.where, plan.how, plan.step);
  shown.part(fmt::format("learning {} at step {:g}", plan.family, plan.step), work);
  if (plan.enough) return learn_enough(system, plan, shown);
  return system.learn(plan, shown.counter(plan.how.trajectories));
}

namespace {

bool is_found(const fit_summary& fit) { return fit.usable && fit.follows_to_the_end(); }

/// Whether the one follows the data for more steps, or for as many with a smaller error.
bool is_better(const fit_summary& one, const fit_summary& other) {
  if (one.usable != other.usable) return one.usable;
  const auto followed = [](const fit_summary& fit) { return fit.follows ? fit.loss_steps : 0; };
  if (followed(one) != followed(other)) return followed(one) > followed(other);
  if (one.loss_steps != other.loss_steps) return one.loss_steps > other.loss_steps;
  return one.held_out_loss < other.held_out_loss;
}

}  // namespace

std::vector<learned_scheme> learn_curve(const prepared_problem& system, learn_plan plan,
                                        std::vector<double> steps, progress& shown) {
  std::sort(steps.begin(), steps.end());
  std::vector<learned_scheme> learned;
  const auto learn_at = [&](std::size_t n, const std::vector<double>& from, bool only_from_there) {
    plan.step = steps[n];
    plan.from = from;
    plan.only_from_there = only_from_there;
    return learn_with(system, plan, shown);
  };
  std::vector<double> from;
  bool is_near = false;
  for (std::size_t n = steps.size(); n-- > 0;) {
    learned.insert(learned.begin(), learn_at(n, from, is_near));
    from = theta_of(learned.front().fit);
    is_near = is_found(learned.front().fit);
  }
  // Back to larger steps, where the search from elsewhere found nothing that follows the data so far.
  for (std::size_t n = 1; n < steps.size(); ++n) {
    if (is_found(learned[n].fit) || !learned[n - 1].fit.usable) continue;
    learned_scheme other = learn_at(n, theta_of(learned[n - 1].fit), true);
    if (is_better(other.fit, learned[n].fit)) learned[n] = std::move(other);
  }
  return learned;
}

learn_plan plan_for(const std::string& family, std::optional<placement> where, double step,
                    const learning_options& how, const common_settings& common) {
  return {.family = family,
          .where = where,
          .step = step,
          .how = how,
          .seed = seed_for(role::training, common.seed),
          .held_out_seed = seed_for(role::held_out, common.seed),
          .threads = common.execution.threads};
}

void prepare_starts(prepared_problem& system, const common_settings& common, progress& shown,
                    std::vector<std::string>& warnings) {
  shown.part("preparing the starts");
  system.prepare_starts(seed_for(role::training, common.seed));
  if (const auto& text = system.warning_of_starts(); !text.empty()) warnings.push_back(text);
}

std::vector<double> theta_of(const fit_summary& fit) {
  std::vector<double> theta;
  for (const auto& parameter : fit.parameters) theta.push_back(parameter.value);
  return theta;
}

}  // namespace nysalt::program
