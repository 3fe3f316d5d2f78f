// SPDX-License-Identifier: BSL-1.0
// Candidates of a recommendation.
#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "catalogue.hpp"
#include "checks.hpp"
#include "learning.hpp"
#include "nysalt/stepping/served_letters.hpp"
#include "purpose.hpp"
#include "recommendation.hpp"
#include "seeds.hpp"

namespace nysalt::program {

void recommendation::require_sound_command() {
  const int goals =
      options_.budget.has_value() + options_.budget_seconds.has_value() + options_.error.has_value();
  if (goals != 1) {
    refuse(
        "recommend: one of {} (force evaluations per unit time), {} (per unit time of a trajectory) and {} "
        "(to stay below) must be given, got {}",
        spelled("budget"), spelled("budget_seconds"), spelled("error"), goals);
  }
  if (options_.budget) require_positive("budget", *options_.budget);
  if (options_.budget_seconds) require_positive("budget_seconds", *options_.budget_seconds);
  if (options_.error) require_positive("error", *options_.error);
  require_positive("horizon", options_.horizon);
  if (options_.learning.purpose == for_sampling) {
    refuse_value(
        "purpose",
        "must be state, energy or distribution for runs, got sampling; call recommend_for_sampling()");
  }
  settle_purpose(options_.learning, system_->heat_bath(), "learning.");
  require_at_least_one("trajectories", options_.trajectories);
  require_sound(options_.learning, "learning.");
  if (options_.error && options_.trajectories < 2) {
    refuse_value("trajectories", "must be at least 2 with {}, got {}: one says nothing of others",
                 spelled("error"), options_.trajectories);
  }
  require_positive("hmc_temperature", options_.hmc_temperature);
  require_at_least_one("looks", options_.looks);
  placement_asked(options_.placement);
  if (options_.metric == "distribution" || options_.metric == "acf") {
    refuse(
        "recommend: {} must be an error along trajectories, path, state, exchange, energy or acceptance, got "
        "{}",
        spelled("metric"), options_.metric);
  }
  const double nominal = 1e-3 * options_.horizon;
  system_->require_measure(
      metric(), plan_at(nominal, options_.trajectories, seed_for(role::test, common_.seed)), {}, 1);
}

double recommendation::rate_of_motion() const {
  const double known = system_->fastest_rate();
  return known > 0.0 ? known : 2.0 * std::numbers::pi / options_.horizon;
}

/// Methods that repeat another at equal cost do not take part, nor letters O where there is no bath.
void recommendation::plan_classical() {
  for (const auto& name : method_names()) {
    if (name.ends_with("_2x")) continue;
    candidate contender{.source = find_method(name), .where = {}};
    const bool has_bath = system_->heat_bath().acts();
    if (contender.source.fixed) {
      const method& method = *contender.source.fixed;
      if (!has_bath && method.letters().stochastic_letters > 0) continue;
      contender.order = method.order;
      contender.symmetric = method.symmetric;
      contender.is_symplectic = method.letters().is_symplectic;
      contender.rotates = method.letters().reads_modes;
    } else {
      contender.order = contender.source.adaptive->properties.order;
      contender.symmetric = contender.source.adaptive->properties.symmetric;
    }
    consider(std::move(contender));
  }
}

void recommendation::plan_families() {
  const auto names = options_.families.empty() ? family_names() : options_.families;
  const std::size_t before = all_.size();
  bool fixes = options_.learning.fix.empty();
  for (const auto& name : names) {
    const auto family = family_named(name, system_->letters());
    if (!is_fixed_in(family)) continue;
    fixes = true;
    candidate contender{.source = find_method("learned:" + name, {}, system_->letters()), .where = {}};
    contender.order = family.order;
    contender.symmetric = family.symmetric;
    contender.is_symplectic = family.letters.is_symplectic;
    contender.rotates = family.letters.reads_modes;
    consider(std::move(contender));
  }
  if (!fixes)
    refuse_value("fix", "must name parameters of a family that is learned here, got {}",
                 listed(options_.learning.fix));
  const bool asked = !options_.families.empty() || !options_.learning.fix.empty();
  if (all_.size() == before && asked) {
    refuse("cannot recommend {}: {}", left_out_.back().first, left_out_.back().second);
  }
}

bool recommendation::is_fixed_in(const family& family) const {
  const auto& names = family.parameter_names;
  return std::ranges::all_of(options_.learning.fix, [&](const std::string& text) {
    return std::ranges::find(names, text.substr(0, text.find('='))) != names.end();
  });
}

/// Takes part, or is left out with the reason why.
void recommendation::consider(candidate contender) {
  const std::string name = contender.source.typed;
  charge(contender.source, *system_);
  const auto leave_out = [&](const std::string& why) { left_out_.emplace_back(name, why); };
  if ((options_.reversible || options_.metric == "acceptance") && !contender.symmetric) {
    return leave_out("it is not reversible");
  }
  if (options_.metric != "acceptance" && !contender.is_symplectic) {
    const bool is_asked = contender.is_learned() && !options_.families.empty();
    if (is_asked) leave_out("it is not symplectic, and for sampling only");
    return;
  }
  if (const std::string why = objection_to_order(contender.source, *system_); !why.empty()) {
    return leave_out(why);
  }
  try {
    const auto otherwise = placement_asked(options_.placement);
    double rate = rate_of_motion();
    if (options_.budget) rate = *options_.budget - processing_of(contender);
    if (rate <= 0.0) {
      return leave_out(fmt::format("the processor without the kernel takes {:g} evaluations per unit time",
                                   processing_of(contender)));
    }
    contender.step = contender.source.evaluations_per_step / rate;
    if (contender.is_learned()) contender.where = placement_in(contender.source, *system_, otherwise);
    if (options_.budget) {
      if (contender.step > options_.horizon * (1.0 + 1e-9)) {  // the rounding that steps_within() allows
        return leave_out(
            fmt::format("{} must be at least {:g}, for one step within {}, got {}", spelled("budget"),
                        contender.source.evaluations_per_step / options_.horizon + processing_of(contender),
                        spelled("horizon"), *options_.budget));
      }
      plan_at(contender.step, options_.trajectories, 0);
      if (!contender.is_learned()) {
        std::vector<std::string> ignored;  // what is not stable is seen to diverge
        contender.method =
            coefficients_at(contender.source, *system_, contender.step, false, otherwise, ignored);
      }
    } else if (contender.source.fixed) {
      system_->require_served(contender.source.fixed->letters());
    }
    if (contender.is_learned()) {
      system_->require_learnable(*contender.source.family, contender.where, options_.learning,
                                 contender.step);
    }
    all_.push_back(std::move(contender));
  } catch (const refusal& problem) {
    leave_out(problem.what());
  } catch (const std::invalid_argument& problem) {
    leave_out(problem.what());
  }
}

}  // namespace nysalt::program
