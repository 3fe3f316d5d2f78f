// SPDX-License-Identifier: BSL-1.0
// Candidates of a recommendation, their steps, and their errors.
#include "recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catalogue.hpp"
#include "checks.hpp"
#include "learning.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "seeds.hpp"

namespace nysalt::program {

recommendation::recommendation(std::unique_ptr<prepared_problem> system, recommendation_options asked,
                               common_settings common)
    : options_(std::move(asked)), common_(std::move(common)), system_(std::move(system)) {
  if (options_.observable.empty()) options_.observable = system_->default_observable();
  require_sound_command();
  plan_classical();
  plan_families();
  if (all_.empty()) {
    refuse("cannot recommend a method: none suits ({}: {})", left_out_.front().first,
           left_out_.front().second);
  }
}

void recommendation::learn_and_rank(const choice_observer& keep) {
  keep_ = keep;
  prepare_starts(*system_, common_, shown_, warnings_);
  time_steps();
  if (options_.budget) {
    by_evaluations_ = {.unit = cost_unit::evaluations,
                       .budget = options_.budget,
                       .cost_ratio = 1.0,
                       .statistic = statistic(false),
                       .all = all_};
    run(*by_evaluations_);
    const candidate* best = by_evaluations_->best();
    by_seconds_ = best != nullptr ? at_equal_seconds(best->seconds_per_time, &*by_evaluations_)
                                  : contest(*by_evaluations_);
    run(*by_seconds_);
  } else if (options_.budget_seconds) {
    by_seconds_ = at_equal_seconds(*options_.budget_seconds, nullptr);
    run(*by_seconds_);
  } else {
    rank_at_one_error();
  }
  shown_.clear();
  warn_of_reference(asked());
}

namespace {

candidate& candidate_named(contest& among, const std::string& name) {
  return *std::ranges::find_if(among.all,
                               [&](const candidate& contender) { return contender.source.typed == name; });
}

}  // namespace

/// Where a mean turns out to rest on few trajectories, all of it again by quantiles, from the optima found.
void recommendation::rank_at_one_error() {
  for (auto& contender : all_) prepare_search(contender);
  while (true) {
    constexpr double start_up = 1.01;  // a run of n steps may cost one evaluation more
    by_evaluations_ = {.unit = cost_unit::evaluations,
                       .budget = {},
                       .cost_ratio = grid_ratio * start_up,
                       .statistic = statistic(searches_by_quantiles_),
                       .all = all_};
    run(*by_evaluations_);
    by_seconds_ = by_evaluations_;
    by_seconds_->unit = cost_unit::seconds;
    double noise = 0.0;
    for (const bool learned : {true, false}) {
      if (const candidate* contender = by_evaluations_->best_of(learned)) noise += noise_of(*contender);
    }
    by_seconds_->cost_ratio = grid_ratio * (1.0 + noise);
    race_by_seconds();
    run(*by_seconds_);
    if (searches_by_quantiles_ || !(is_heavy(*by_evaluations_) || is_heavy(*by_seconds_))) return;
    searches_by_quantiles_ = true;
    for (auto& contender : all_) {
      contender.search.thetas = candidate_named(*by_evaluations_, contender.source.typed).search.thetas;
      prepare_search(contender);
    }
  }
}

/// Those that were left behind by evaluations, but not by seconds, go on.
void recommendation::race_by_seconds() {
  std::vector<candidate*> all;
  for (candidate& one : by_seconds_->all) {
    if (one.is_left_behind) one.reason.clear();
    if (one.reason.empty()) all.push_back(&one);
  }
  const auto is_over = [](const candidate* one) { return !one->is_left_behind || !one->reason.empty(); };
  leave_behind_by_cost(all, cost_unit::seconds);
  std::erase_if(all, is_over);
  for (candidate* one : all) one->is_left_behind = false;
  find_steps(all, cost_unit::seconds);
  measure_on_test(all, options_.trajectories);
}

std::vector<std::vector<std::string>> recommendation::parts_of(const contest& among) {
  std::vector<std::vector<std::string>> parts(2);
  for (const auto& contender : among.all) {
    if (!contender.reason.empty() || !contender.error.scores.empty()) continue;
    parts[contender.is_learned() ? 1 : 0].push_back(contender.source.typed);
  }
  std::erase_if(parts, [](const auto& names) { return names.empty(); });
  return parts;
}

/// Part by part what has no error yet is prepared and measured, and the best are examined until they are
/// confirmed: so there is a method to take from the first part on, whenever the work ends.
void recommendation::run(contest& among) {
  for (const auto& part : parts_of(among)) {
    std::vector<candidate*> fresh;
    for (const auto& name : part) fresh.push_back(&candidate_named(among, name));
    if (options_.error) {
      find_steps(fresh, among.unit);
      measure_on_test(fresh, options_.trajectories);
    } else {
      race(among, fresh);
    }
    do settle(among);
    while (call_back(among));
    if (&among == &asked()) tell_of_best();
  }
}

void recommendation::tell_of_best() {
  if (!keep_) return;
  const auto best = chosen();
  if (!best || best->text == kept_) return;
  kept_ = best->text;
  keep_(*best);
}

bool recommendation::is_heavy(const contest& among) const {
  return std::ranges::any_of(among.all, [](const candidate& contender) {
    return contender.is_eligible() &&
           (contender.error.is_heavy || (contender.confirmed && contender.confirmed->is_heavy));
  });
}

void recommendation::settle(contest& among) {
  while (true) {
    // One statistic for all: else they could not be ranked.
    if (among.budget && !among.statistic.is_quantile && is_heavy(among)) among.statistic = statistic(true);
    if (options_.error) {
      for (auto& contender : among.all) {
        if (!contender.is_eligible() || contender.confirmed) continue;
        if (!(among.statistic.lower_bound(contender.error.scores) > *options_.error)) continue;
        contender.reason = fmt::format("on fresh trajectories its error is {:.2e}, above {:g}",
                                       among.error_of(contender), *options_.error);
      }
    }
    among.rank();
    candidate* next = nullptr;
    for (auto& contender : among.all) {
      const bool is_best = &contender == among.best_of(true) || &contender == among.best_of(false);
      if (is_best && !contender.confirmed) next = &contender;
    }
    if (next != nullptr) {
      confirm(among, *next);
    } else if (!confirm_on_more(among)) {
      break;
    }
  }
}

bool recommendation::confirm_on_more(contest& among) {
  constexpr double matters = 1.3;    // a smaller factor between errors is no reason to choose
  constexpr std::int64_t most = 16;  // times as many; half an interval of 100 trajectories is a quarter then
  const auto candidate_of = [&](bool learned) {
    const candidate* best = among.best_of(learned);
    const auto found = std::ranges::find_if(among.all, [&](const candidate& one) { return &one == best; });
    return found != among.all.end() && found->confirmed ? &*found : nullptr;
  };
  candidate* learned = candidate_of(true);
  candidate* classical = candidate_of(false);
  if (!among.budget || learned == nullptr || classical == nullptr) return false;
  const ratio_estimate ratio = among.error_ratio(*classical, *learned);
  const bool is_close = ratio.low > 1.0 / matters && ratio.high < matters;
  const bool is_decided = ratio.is_above_one() || ratio.is_below_one() || is_close;
  const std::int64_t before = std::min(learned->confirmed->trajectories, classical->confirmed->trajectories);
  if (is_decided || std::isnan(ratio.value) || before >= most * options_.trajectories) return false;
  const std::int64_t count = 4 * before;
  for (candidate* one : {learned, classical}) {
    if (one->confirmed->trajectories < count) confirm_on(*one, count);
  }
  return true;
}

void recommendation::confirm_on(candidate& contender, std::int64_t trajectories) {
  candidate again = contender;
  measure_at(contender.step, {&again}, trajectories, seed_for(role::confirmation, common_.seed));
  contender.confirmed = again.error;
  if (again.error.diverged > 0) {
    contender.reason =
        fmt::format("{} of {} fresh trajectories diverged", again.error.diverged, trajectories);
  }
}

void recommendation::confirm(contest& among, candidate& contender) {
  std::string why = objection_to(contender);
  if (why.empty()) {
    confirm_on(contender, options_.trajectories);
    why = std::exchange(contender.reason, {});
    if (why.empty() && options_.error) {
      const double most = among.statistic.upper_bound(contender.confirmed->scores);
      if (!(most <= *options_.error))
        why = fmt::format("on fresh trajectories its error may be {:.2e}", most);
    }
  }
  if (why.empty()) return;
  if (options_.error) {
    step_down(contender);
    if (contender.reason.empty()) return;
    contender.reason += ": " + why;
  } else {
    contender.reason = why;
  }
}

std::string recommendation::objection_to(const candidate& contender) const {
  const judgement& found = system_->judged(*contender.method, contender.step, common_.execution.threads);
  return found.holds() ? std::string() : fmt::format("at step {:g}: {}", contender.step, found.in_words());
}

error_statistic recommendation::statistic(bool by_quantiles) const {
  const bool is_root = options_.metric == "state" || options_.metric == "energy";
  return {is_root, by_quantiles};
}

}  // namespace nysalt::program
