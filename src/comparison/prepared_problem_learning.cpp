// SPDX-License-Identifier: BSL-1.0
// Learning on a problem.
#include <algorithm>
#include <array>
#include <utility>

#include "all_ranks.hpp"
#include "catalogue.hpp"
#include "family_options.hpp"
#include "kept_answers.hpp"
#include "model_reference.hpp"
#include "nysalt/learn.hpp"
#include "prepared_problem.hpp"
#include "refusal.hpp"

namespace nysalt::program {

void prepared_problem::require_learnable(const std::string& name, std::optional<placement> where,
                                         const learning_options& how, double step) const {
  const nysalt::family family = placed(name, where, letters());
  if (family.parameters() == 0) {
    refuse(
        "{} must have coefficients to learn beyond the sums, got none; take the word as a method, or a "
        "longer word",
        name);
  }
  if (const auto given = given_states()) {
    refuse(
        "{} must be learned from starts that differ, and tried on others, got {} to begin at; give {} for "
        "deviations of their starts",
        name, *given == 1 ? "one state" : fmt::format("{} states", *given), spelled("spread"));
  }
  require_served(family.letters);
  require_sound_letters(name, family.letters, step);
  reference().fine_step(step, how.fine_step, noise_parts(family));
  const auto which = how.coordinates.empty() ? coordinates::qp : coordinates_named(how.coordinates);
  if (which != coordinates::qp && !has_modes(made_.system)) {
    refuse("{} must declare modes for the {} coordinates, got none; take qp", description(), how.coordinates);
  }
  const auto options = options_for(family, how, 1);
  const loss_choice chosen = options.loss.value_or(usual_loss(made_.system.bath()));
  const loss_kind& loss = *chosen.kind;
  const double horizon = how.horizon_at(step);
  if (loss.asks_data() && static_cast<double>(chosen.steps) * step > horizon * (1.0 + 1e-9)) {
    refuse("trajectories must be as long as the {} steps of {} of the loss, got {}; take a longer horizon",
           chosen.steps, step, horizon);
  }
  if (loss.needs_modes && !has_modes(made_.system))
    refuse("{} must declare modes for the {} loss, got none; take another loss", description(), loss.name);
  if (loss.needs_bath && !made_.system.bath().has_temperature()) {
    refuse(
        "the {} loss must be of a system in a bath, which has a stationary distribution; give {} with {} or "
        "{}",
        loss.name, spelled("friction"), spelled("temperature"), spelled("sigma"));
  }
}

std::int64_t prepared_problem::most_trajectories(const learn_plan& plan) const {
  const data_options options{.step = plan.step,
                             .horizon = plan.how.horizon_at(plan.step),
                             .noise_parts = noise_parts(placed(plan.family, plan.where, letters()))};
  return nysalt::detail::most_trajectories(options, size(made_.system));
}

learned_scheme prepared_problem::learn(const learn_plan& plan, const counter& progress) const {
  require_learnable(plan.family, plan.where, plan.how, plan.step);
  const nysalt::family family = placed(plan.family, plan.where, letters());
  const json question{"learn",
                      plan.family,
                      plan.where ? static_cast<int>(*plan.where) : -1,
                      plan.step,
                      plan.how.trajectories,
                      plan.how.horizon_at(plan.step),
                      plan.how.loss,
                      plan.how.effort,
                      plan.how.random_starts.value_or(-1),
                      plan.seed,
                      plan.from,
                      plan.only_from_there,
                      plan.contained,
                      plan.goes_on};
  const auto found = once<kept_fit>(answers_, question, [&] {
    learned_scheme learned = learn_from_data(plan, family, progress);
    return kept_fit{std::move(learned.fit), learned.method.coefficients(), learned.energies};
  });
  return {found.fit,
          {family.name,
           family.letters,
           found.coefficients,
           {family.order, family.symmetric, family.requires_quadratic_kinetic}},
          found.energies};
}

learned_scheme prepared_problem::learn_from_data(const learn_plan& plan, const nysalt::family& family,
                                                 const counter& progress) const {
  const int parts = noise_parts(family);
  fit_options options = options_for(family, plan.how, plan.threads);
  // The random starts of the search are those of every seed: a seed decides on data, not on the minima that
  // are found.
  options.frequency = frequency_asked_;
  if (plan.goes_on) options.max_iterations = 60;  // where most minima are within some percent of their loss
  options.check_force = false;                    // systems of users were checked when they were made
  if (progress) {
    options.execution.progress = [&progress, all = plan.how.trajectories](std::int64_t) { progress(all); };
  }
  const auto as_vector = [](const std::vector<double>& theta) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(theta.data(), std::ssize(theta));
  };
  if (!plan.contained.empty()) options.contained = as_vector(plan.contained);
  if (!plan.from.empty()) {
    const Eigen::VectorXd theta = as_vector(plan.from);
    if (plan.only_from_there) {
      options.start = theta;
      options.random_starts = 0;
    } else {
      options.further_starts.push_back({"a step nearby", theta});
    }
  }
  using two_sets = std::array<flow_map_data, 2>;
  two_sets fresh;
  auto* kept = plan.kept ? std::any_cast<two_sets>(plan.kept.get()) : nullptr;
  if (plan.kept && kept == nullptr) kept = &plan.kept->template emplace<two_sets>();
  auto& data = (kept != nullptr ? *kept : fresh)[0];
  auto& held_out = (kept != nullptr ? *kept : fresh)[1];
  const auto reference_solution = reference().at(plan.step, plan.how.fine_step, parts);
  const auto make = [&](auto& pairs, std::uint64_t seed) {
    detail::extend_data(made_.system, *starts_, reference_solution,
                        {.step = plan.step,
                         .horizon = plan.how.horizon_at(plan.step),
                         .trajectories = plan.how.trajectories,
                         .seed = seed,
                         .noise_parts = parts,
                         .execution = {.threads = plan.threads, .ranks = &all_ranks(), .progress = progress}},
                        pairs);
  };
  make(data, plan.seed);
  make(held_out, plan.held_out_seed);
  auto [theta, summary, method] = nysalt::learn(family, made_.system, data, held_out, options);
  return {std::move(summary), method.anywhere(), data.energies};
}

int prepared_problem::noise_parts(const family& family) const {
  if (made_.system.bath().sigma() == 0.0) return 0;
  return detail::intervals_of_noise(family.letters, family.coefficients(family.starts.front().theta)).parts;
}

}  // namespace nysalt::program
