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
double recommendation::grid_step(const candidate& its, int k) const {
  const double half_a_radian = 0.5 / system_->fastest_rate();
  const double exact = half_a_radian * std::exp2(static_cast<double>(k) / points_of_octave);
  const double digit = std::pow(10.0, std::floor(std::log10(exact)) - 2.0);
  return its.source.evaluations_per_step * std::round(exact / digit) * digit;
}

/// What was learned in a search before is kept.
void recommendation::prepare_search(candidate& its) const {
  int above = points_of_octave * octaves + 1;
  while (grid_step(its, above - 1) > command_.horizon) --above;
  its.search = {.below = {}, .above = above, .thetas = std::move(its.search.thetas)};
  its.error = {};
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

void recommendation::find_steps(std::vector<candidate>& all) {
  constexpr std::int64_t few = 24;
  while (true) {
    std::vector<candidate*> on_few;
    std::vector<candidate*> on_all;
    std::vector<std::pair<candidate*, int>> tried;
    for (auto& its : all) {
      const auto k = next_of(its.search);
      if (!k) continue;
      its.search.is_fine = its.search.is_fine || its.search.below == k;
      probe(its, *k);
      tried.emplace_back(&its, *k);
      (its.search.is_fine ? on_all : on_few).push_back(&its);
    }
    if (tried.empty()) break;
    const auto seed = seed_for(role::held_out, common_.seed);
    measure(on_few, std::min(few, command_.trajectories), seed);
    measure(on_all, command_.trajectories, seed);
    for (const auto& [its, k] : tried) judge(*its, k);
  }
  for (auto& its : all) {
    if (its.search.is_found) {
      its.error = {};  // of the trajectories on which the step was chosen
      continue;
    }
    if (its.search.is_given_up) continue;
    its.search.is_given_up = true;
    its.reason = fmt::format("no step down to {:.2g} has an error below {:g}{}", its.step, *command_.error,
                             its.reason.empty() ? "" : ": " + its.reason);
    its.error = {};
  }
}

/// The next smaller step at which it holds, or a reason that there is none.
void recommendation::step_down(candidate& its) {
  its.search.above = its.search.below.value_or(its.search.above);
  its.search.below.reset();
  its.search.has_failed = true;
  its.search.is_found = false;
  its.confirmed.reset();
  std::vector<candidate> alone{its};
  find_steps(alone);
  its = std::move(alone.front());
  if (!its.reason.empty()) return;
  measure_on_test({&its});
}

/// What is learned at a step is the start for the next.
void recommendation::probe(candidate& its, int k) {
  its.step = grid_step(its, k);
  const auto& thetas = its.search.thetas;
  const auto nearest =
      std::ranges::min_element(thetas, {}, [&](const auto& known) { return std::abs(known.first - k); });
  if (nearest == thetas.end()) {
    prepare(its);
  } else {
    prepare(its, nearest->second, !its.search.is_fine);
  }
  if (its.learned && its.learned->fit.usable) its.search.thetas[k] = theta_of(its.learned->fit);
}

void recommendation::judge(candidate& its, int k) const {
  const auto judged = statistic(searches_by_quantiles_);
  const auto& scores = its.error.scores;
  const bool holds =
      its.stands() && (its.search.is_fine ? judged.upper_bound(scores) : judged(scores)) <= *command_.error;
  if (holds) {
    its.search.below = k;
    its.search.is_found = its.search.is_fine;
    return;
  }
  its.search.above = k;
  its.search.has_failed = true;
  if (its.search.below && *its.search.below >= k) its.search.below.reset();
}

}  // namespace nysalt::program
