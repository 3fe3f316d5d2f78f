// SPDX-License-Identifier: BSL-1.0
// Candidates for sampling, the states on which they are judged, and what is learned.
#include "sampling_choice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "all_ranks.hpp"
#include "catalogue.hpp"
#include "checks.hpp"
#include "kept_answers.hpp"
#include "learning.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/hmc.hpp"
#include "purpose.hpp"
#include "seeds.hpp"

namespace nysalt::program {

namespace {

constexpr const char* leapfrog = "verlet";
constexpr const char* two_stages = "mclachlan2v";

/// What samplers ship or their literature proposes, and what no word without a derivative of the force of
/// as many evaluations beats on a lattice.
const std::vector<std::string>& rivals() {
  static const std::vector<std::string> all{leapfrog,           two_stages, "bcss2v",    "bcss3",
                                            "predescu3",        "bcss4",    "omelyan5v", "srkn6b",
                                            "chin4a_displaced", "s_aia2",   "s_aia3"};
  return all;
}

/// Of four digits, as people type steps.
double four_digits(double x) {
  const double digit = std::pow(10.0, std::floor(std::log10(x)) - 3.0);
  return std::round(x / digit) * digit;
}

}  // namespace

sampling_choice::sampling_choice(std::unique_ptr<prepared_problem> system, sampling_options asked,
                                 common_settings common)
    : options_(std::move(asked)), common_(std::move(common)), system_(std::move(system)) {
  require_sound_options();
  plan_candidates();
}

void sampling_choice::require_sound_options() {
  require_positive("length", options_.length);
  require_positive("hmc_temperature", options_.temperature);
  require_positive("times_larger", options_.times_larger);
  if (!(options_.acceptance > 0.0 && options_.acceptance < 1.0)) {
    refuse_value("acceptance", "must be between 0 and 1, got {}", options_.acceptance);
  }
  constexpr std::int64_t fewest = 16;  // that a standard error needs
  if (options_.trajectories < fewest) {
    refuse_value("trajectories", "must be at least {}, got {}", fewest, options_.trajectories);
  }
  const model& target = system_->definition().system;
  if (target.bath().acts()) {
    refuse("{}: {} must have no bath, in which H is not kept; leave {} away", spelled("purpose", "sampling"),
           system_->description(), spelled("friction"));
  }
  if (!has_quadratic_kinetic(target) || !target.facts().has_potential) {
    refuse("{}: {} must have a potential and a kinetic energy that is quadratic in p",
           spelled("purpose", "sampling"), system_->description());
  }
  if (options_.families.empty()) options_.families = {"bab3", "bab4", "bab5", "bab6", "fd_chin"};
  learning_options& how = options_.learning;
  if (!how.horizon) how.horizon = 2.0 * options_.length;
  if (!how.purpose.empty() && how.purpose != for_sampling)
    refuse_value("purpose", "must be sampling for Hybrid Monte Carlo, got {}; leave {} away", how.purpose,
                 spelled("purpose"));
  settle_purpose(how, target.bath(), "learning.", for_sampling);
  require_sound(how, "learning.");
}

void sampling_choice::plan_candidates() {
  for (const auto& name : rivals()) consider(name);
  for (const auto& name : options_.families) consider("learned:" + name);
  for (const auto& [name, reason] : left_out_) {
    if (name.starts_with("learned:")) refuse("cannot recommend {}: {}", name, reason);
  }
}

/// Takes part, or is left out with the reason why.
void sampling_choice::consider(const std::string& name) {
  sampling_candidate candidate{.source = find_method(name, {}, system_->letters())};
  charge(candidate.source, *system_);
  const auto leave_out = [&](const std::string& why) { left_out_.emplace_back(name, why); };
  try {
    if (candidate.is_learned()) {
      const auto family = family_named(*candidate.source.family, system_->letters());
      if (!family.symmetric) return leave_out("it is not reversible");
      system_->require_learnable(*candidate.source.family, {}, options_.learning, options_.length);
    } else if (candidate.source.fixed) {
      system_->require_served(candidate.source.fixed->letters());
    } else if (!candidate.source.adaptive->frequency(*system_)) {
      return leave_out(fmt::format("{} has no frequency that is known", system_->description()));
    }
    all_.push_back(std::move(candidate));
  } catch (const refusal& problem) {
    leave_out(problem.what());
  }
}

/// States of exp(-H/kT): those that were given, or the draws of chains with a cheap word. Half of them are
/// learned from, and words are judged on the others.
void sampling_choice::run_pilot() {
  const model& target = system_->definition().system;
  const double fastest = system_->definition().frequency;
  guess_ = std::min(options_.length, fastest > 0.0 ? 0.2 / fastest : 0.05 * options_.length);
  if (options_.starts_are_thermal) {
    states_ = system_->prepared_starts();
    return;
  }
  shown_.part("pilot chains");
  constexpr std::int64_t chains = 16;
  constexpr std::int64_t burn_in = 500;
  constexpr std::int64_t fewest_draws = 100;  // of a chain, by which R is known to some percent
  const std::int64_t kept = 2 * (options_.trajectories + options_.learning.trajectories);
  const std::int64_t kept_of_chain = (kept + chains - 1) / chains;
  const std::int64_t apart = std::max<std::int64_t>(2, fewest_draws / kept_of_chain);
  const std::int64_t draws = apart * kept_of_chain;
  const hmc_options pilot{.step = 2.0 * guess_,
                          .length = options_.length,
                          .temperature = options_.temperature,
                          .chains = chains,
                          .burn_in = burn_in,
                          .draws = draws,
                          .acceptance = options_.acceptance,
                          .seed = seed_for(role::training, common_.seed),
                          .execution = {.threads = common_.execution.threads,
                                        .progress = shown_.counter(chains * (burn_in + draws))}};
  std::vector<std::vector<Eigen::VectorXd>> positions(chains);
  std::vector<std::vector<double>> potentials(chains);
  const auto keep = [&](const hmc_draw& draw) {
    const auto chain = static_cast<std::size_t>(draw.chain);
    if (draw.number % apart == 0) positions[chain].push_back(draw.q);
    potentials[chain].push_back(draw.potential);
  };
  hmc_result result;
  try {
    result = hmc(target, *find_method(two_stages).fixed, system_->prepared_starts(), pilot, keep);
  } catch (const std::invalid_argument& problem) {
    refuse("cannot run pilot chains: {}", problem.what());
  }
  guess_ = 0.5 * result.step;
  const double reduction = potential_scale_reduction(potentials);
  constexpr double converged = 1.1;
  if (!(reduction < converged)) {
    warnings_.push_back(
        fmt::format("pilot chains are not shown to agree: R of the potential is {:.3g}; take a larger {}, or "
                    "{} FILE.csv with the draws of nysalt sample",
                    reduction, spelled("length"), spelled("start")));
  }
  std::vector<vector<double, Eigen::Dynamic>> learned_from;
  std::vector<vector<double, Eigen::Dynamic>> judged_on;
  for (auto& chain : positions) {
    for (std::size_t n = 0; n < chain.size(); ++n) {
      (2 * n < chain.size() ? learned_from : judged_on).push_back(std::move(chain[n]));
    }
  }
  const auto thermal = [&](auto& list) {
    return thermal_positions(target, std::move(list), options_.temperature);
  };
  system_->take_starts(thermal(learned_from));
  states_ = thermal(judged_on);
}

proposal_options sampling_choice::proposals(std::uint64_t seed) const {
  return {.length = options_.length,
          .temperature = options_.temperature,
          .times_larger = options_.times_larger,
          .states = options_.trajectories,
          .seed = seed,
          .execution = {.threads = common_.execution.threads, .ranks = &all_ranks()}};
}

method sampling_choice::method_at(const sampling_candidate& candidate, double step) const {
  if (candidate.learned) return candidate.learned->method;
  if (candidate.source.fixed) return *candidate.source.fixed;
  return candidate.source.adaptive->at(step * candidate.source.adaptive->frequency(*system_)->value);
}

std::optional<acceptance_step> sampling_choice::step_of(const sampling_candidate& candidate, double guess,
                                                        std::uint64_t seed, std::string& reason) const {
  try {
    const auto at = [&](double step) { return method_at(candidate, step); };
    json question{"step", candidate.source.typed, guess, seed};
    if (candidate.learned) question.push_back(candidate.learned->method.coefficients());
    return once<acceptance_step>(system_->answers(), question, [&] {
      return step_at_acceptance(system_->definition().system, at, options_.acceptance, guess, *states_,
                                proposals(seed));
    });
  } catch (const std::invalid_argument& problem) {
    reason = problem.what();
  } catch (const std::runtime_error& problem) {
    reason = problem.what();
  }
  return std::nullopt;
}

/// The largest step for which a word can be learned that is accepted as often as asked there: such steps are
/// tried from the first on, each search beginning at what was found before, too. Kept is the word that takes
/// the largest step.
void sampling_choice::learn(sampling_candidate& candidate, double first_step) {
  constexpr int rounds = 7;
  constexpr double growth = 1.12;
  constexpr double close = 1.03;  // of two steps: the error bars of a hundred states
  constexpr double holds_from = 0.99;
  const auto seed = seed_for(role::held_out, common_.seed);
  double step = std::min(first_step, options_.length);
  double low = 0.0;   // the largest step that holds
  double high = 0.0;  // the smallest that does not; 0: none is known
  for (int round = 0; round < rounds; ++round) {
    sampling_candidate trial = candidate;
    trial.found.reset();
    step = four_digits(step);
    learn_plan plan = plan_for(*candidate.source.family, {}, step, options_.learning, common_);
    if (candidate.learned) plan.from = theta_of(candidate.learned->fit);
    std::string reason;
    try {
      trial.learned = learn_with(*system_, plan, shown_);
      trial.plan = plan;
      reason = trial.learned->fit.usable ? "" : "the fit is not usable: " + trial.learned->fit.reason;
      if (reason.empty()) trial.found = step_of(trial, step, seed, reason);
    } catch (const refusal& problem) {
      reason = problem.what();
    }
    const bool is_better = trial.found && (!candidate.found || trial.found->step > candidate.found->step);
    if (is_better) candidate = trial;
    candidate.reason = candidate.found ? "" : reason;
    if (trial.found && trial.found->step >= holds_from * step) {
      low = std::max(low, trial.found->step);
    } else {
      high = step;
    }
    if (low >= options_.length || (high > 0.0 && low > 0.0 && high < close * low)) return;
    if (low == 0.0) {
      step = trial.found ? trial.found->step : 0.75 * step;
    } else {
      step = std::min(high > low ? std::sqrt(low * high) : growth * low, options_.length);
    }
  }
}

/// Steps are searched, and words learned, on some momenta, and all words are judged on others.
void sampling_choice::learn_and_rank(const choice_observer& keep) {
  const auto tell_of_best = [&] {
    sort_by_step();
    if (const auto best = chosen(); keep && best) keep(*best);
  };
  prepare_starts(*system_, common_, shown_, warnings_);
  run_pilot();
  shown_.part("steps of classical words");
  double best = 0.0;
  for (auto& candidate : all_) {
    if (candidate.is_learned()) continue;
    const double guess = guess_ * candidate.source.evaluations_per_step *
                         std::pow(std::max(1.0, options_.times_larger), -0.25);
    candidate.found = step_of(candidate, guess, seed_for(role::held_out, common_.seed), candidate.reason);
    if (candidate.found) best = std::max(best, candidate.step_of_evaluation());
  }
  if (!(best > 0.0)) best = guess_;
  constexpr double farther = 1.1;  // than what is known
  std::vector<std::string> to_learn;
  for (const auto& candidate : all_) {
    if (candidate.is_learned()) to_learn.push_back(candidate.source.typed);
  }
  tell_of_best();
  shown_.count(to_learn.size(), "families");
  for (const auto& name : to_learn) {
    shown_.next();
    auto& candidate = *std::ranges::find_if(all_, [&](const auto& one) { return one.source.typed == name; });
    learn(candidate, farther * best * candidate.source.evaluations_per_step);
    tell_of_best();
  }
  shown_.count(0, {});
  shown_.part("steps of all words");
  for (auto& candidate : all_) {
    if (!candidate.found) continue;
    candidate.found =
        step_of(candidate, candidate.found->step, seed_for(role::test, common_.seed), candidate.reason);
  }
  sort_by_step();
  shown_.clear();
}

void sampling_choice::sort_by_step() {
  std::ranges::stable_sort(all_, [](const sampling_candidate& a, const sampling_candidate& b) {
    if (a.is_eligible() != b.is_eligible()) return a.is_eligible();
    return a.is_eligible() && a.step_of_evaluation() > b.step_of_evaluation();
  });
}

const sampling_candidate* sampling_choice::best_of(bool learned) const {
  for (const auto& candidate : all_) {
    if (candidate.is_eligible() && candidate.is_learned() == learned) return &candidate;
  }
  return nullptr;
}

const sampling_candidate* sampling_choice::named(const std::string& name) const {
  const auto found = std::ranges::find_if(
      all_, [&](const auto& one) { return one.source.typed == name && one.is_eligible(); });
  return found == all_.end() ? nullptr : &*found;
}

sampling_ratio sampling_choice::ratio_of(const sampling_candidate& a, const sampling_candidate& b) const {
  const double value = a.step_of_evaluation() / b.step_of_evaluation();
  const auto difference = paired_difference(a.found->log_of_each, b.found->log_of_each);
  return {value, value * difference.standard_error};
}

std::string sampling_choice::verdict() const {
  const auto* learned = best_of(true);
  const auto* classical = best_of(false);
  if (learned == nullptr && classical == nullptr) return "none";
  if (classical == nullptr) return "learned";
  if (learned == nullptr) return "classical";
  const auto ratio = ratio_of(*learned, *classical);
  return ratio.is_above_one() ? "learned" : ratio.is_below_one() ? "classical" : "tie";
}

const sampling_candidate* sampling_choice::taken() const {
  return verdict() == "learned" ? best_of(true) : best_of(false);
}

}  // namespace nysalt::program
