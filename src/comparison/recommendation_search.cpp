// SPDX-License-Identifier: BSL-1.0
// The largest step with an error below the one asked for, of each method.
#include <algorithm>
#include <cmath>

#include "learning.hpp"
#include "recommendation.hpp"
#include "seeds.hpp"

namespace nysalt::program {

namespace {
constexpr int points_of_octave = 4;  // a ratio of 1.19
constexpr int octaves = 6;           // down from where an evaluation covers half a radian, and up
}  // namespace

const double recommendation::grid_ratio = std::exp2(1.0 / points_of_octave);

/// The same steps per evaluation for all, so that methods of as many evaluations share the reference; of
/// three digits, as people type them.
double recommendation::grid_step(const candidate& contender, int k) const {
  const double half_a_radian = 0.5 / rate_of_motion();
  const double exact = half_a_radian * std::exp2(static_cast<double>(k) / points_of_octave);
  const double digit = std::pow(10.0, std::floor(std::log10(exact)) - 2.0);
  return contender.source.evaluations_per_step * std::round(exact / digit) * digit;
}

/// What was learned in a search before is kept.
void recommendation::prepare_search(candidate& contender) const {
  int above = points_of_octave * octaves + 1;
  while (grid_step(contender, above - 1) > options_.horizon) --above;
  contender.search = {.below = {}, .above = above, .thetas = std::move(contender.search.thetas)};
  contender.error = {};
}

/// Octave by octave until the error crosses the one asked for, then halves of what lies between. What was
/// found on few trajectories is tried on all of them, and steps go down from there while it fails.
std::optional<int> recommendation::next_of(const bracket& search) {
  if (search.is_found || search.above <= -points_of_octave * octaves) return std::nullopt;
  if (!search.below) {
    if (!search.has_failed) return std::min(0, search.above - 1);
    return search.is_fine ? search.above - 1 : search.above - points_of_octave;
  }
  if (search.above - *search.below == 1) return *search.below;
  if (!search.has_failed) return std::min(*search.below + points_of_octave, search.above - 1);
  return *search.below + (search.above - *search.below) / 2;
}

bool recommendation::search_on(const std::vector<candidate*>& all, bool on_few) {
  constexpr std::int64_t few = 24;
  std::vector<std::pair<candidate*, int>> tried;
  std::vector<candidate*> contenders;
  for (candidate* contender : all) {
    const auto k = next_of(contender->search);
    if (!k || contender->is_left_behind) continue;
    if (on_few && (contender->search.is_fine || contender->search.below == k)) continue;
    contender->search.is_fine = !on_few;
    probe(*contender, *k, on_few ? few : options_.learning.trajectories);
    tried.emplace_back(contender, *k);
    contenders.push_back(contender);
  }
  measure(contenders, on_few ? std::min(few, options_.trajectories) : options_.trajectories,
          seed_for(role::held_out, common_.seed));
  for (const auto& [contender, k] : tried) judge(*contender, k);
  return !tried.empty();
}

void recommendation::find_steps(const std::vector<candidate*>& all, cost_unit unit) {
  while (search_on(all, true)) {
  }
  leave_behind_by_cost(all, unit);
  while (search_on(all, false)) {
  }
  for (candidate* contender : all) {
    if (contender->search.is_found) {
      contender->error = {};  // of the trajectories on which the step was chosen
      continue;
    }
    if (contender->search.is_given_up || contender->is_left_behind) continue;
    contender->search.is_given_up = true;
    contender->reason =
        fmt::format("no step down to {:.2g} has an error below {:g}{}", contender->step, *options_.error,
                    contender->reason.empty() ? "" : ": " + contender->reason);
    contender->error = {};
  }
}

/// The next smaller step at which the error is below the one asked for, or a reason that there is none.
void recommendation::step_down(candidate& contender) {
  contender.search.above = contender.search.below.value_or(contender.search.above);
  contender.search.below.reset();
  contender.search.has_failed = true;
  contender.search.is_found = false;
  contender.confirmed.reset();
  find_steps({&contender}, asked().unit);  // of one alone, none is left behind
  if (!contender.reason.empty()) return;
  measure_on_test({&contender}, options_.trajectories);
}

/// Those are left behind whose steps are too small to win. What few trajectories say of a step may be wrong
/// by a point of the grid, and so may that of the best. The contest by evaluations must not depend on the
/// clock: each contest leaves behind by its own cost.
void recommendation::leave_behind_by_cost(const std::vector<candidate*>& racing, cost_unit unit) const {
  const double slack = grid_ratio * grid_ratio;
  const candidate* least = nullptr;
  const auto cost_of = [&](const candidate& one) {
    const double step = grid_step(one, *one.search.below);
    return unit == cost_unit::evaluations ? one.source.evaluations_per_step / step + processing_of(one)
                                          : seconds_of_step(one) / step + seconds_of_processing(one);
  };
  for (const candidate* one : racing) {
    if (!one->search.below || !one->reason.empty()) continue;
    if (least == nullptr || cost_of(*one) < cost_of(*least)) least = one;
  }
  for (candidate* one : racing) {
    if (!one->search.below || !one->reason.empty() || one->search.is_found) continue;
    const double ratio = cost_of(*one) / cost_of(*least);
    if (ratio <= slack) continue;
    one->step = grid_step(*one, *one->search.below);
    one->evaluations_per_time = one->source.evaluations_per_step / one->step + processing_of(*one);
    one->seconds_per_time = seconds_of_step(*one) / one->step + seconds_of_processing(*one);
    one->is_left_behind = true;
    one->reason =
        fmt::format("left behind on {} of {} trajectories: it takes {:.3g} times the {} of {}",
                    one->error.trajectories, options_.trajectories, ratio,
                    unit == cost_unit::evaluations ? "evaluations" : "seconds", least->source.typed);
  }
}

/// What is learned at a step is the start for the next.
void recommendation::probe(candidate& contender, int k, std::int64_t trajectories) {
  contender.step = grid_step(contender, k);
  const auto& thetas = contender.search.thetas;
  const auto nearest =
      std::ranges::min_element(thetas, {}, [&](const auto& known) { return std::abs(known.first - k); });
  if (nearest == thetas.end()) {
    prepare(contender, trajectories);
  } else {
    prepare(
        contender, trajectories,
        {.which = contender.search.is_fine ? start_set::all : start_set::known, .known = nearest->second});
  }
  if (contender.learned && contender.learned->fit.usable)
    contender.search.thetas[k] = theta_of(contender.learned->fit);
}

void recommendation::judge(candidate& contender, int k) const {
  const auto judged = statistic(searches_by_quantiles_);
  const auto& scores = contender.error.scores;
  const bool holds =
      contender.is_eligible() &&
      (contender.search.is_fine ? judged.upper_bound(scores) : judged(scores)) <= *options_.error;
  if (holds) {
    contender.search.below = k;
    contender.search.is_found = contender.search.is_fine;
    return;
  }
  contender.search.above = k;
  contender.search.has_failed = true;
  if (contender.search.below && *contender.search.below >= k) contender.search.below.reset();
}

}  // namespace nysalt::program
