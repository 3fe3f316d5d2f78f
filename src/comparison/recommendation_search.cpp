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

void recommendation::find_steps(const std::vector<candidate*>& all) {
  constexpr std::int64_t few = 24;
  while (true) {
    std::vector<candidate*> on_few;
    std::vector<candidate*> on_all;
    std::vector<std::pair<candidate*, int>> tried;
    for (candidate* contender : all) {
      const auto k = next_of(contender->search);
      if (!k) continue;
      contender->search.is_fine = contender->search.is_fine || contender->search.below == k;
      probe(*contender, *k);
      tried.emplace_back(contender, *k);
      (contender->search.is_fine ? on_all : on_few).push_back(contender);
    }
    if (tried.empty()) break;
    const auto seed = seed_for(role::held_out, common_.seed);
    measure(on_few, std::min(few, options_.trajectories), seed);
    measure(on_all, options_.trajectories, seed);
    for (const auto& [contender, k] : tried) judge(*contender, k);
  }
  for (candidate* contender : all) {
    if (contender->search.is_found) {
      contender->error = {};  // of the trajectories on which the step was chosen
      continue;
    }
    if (contender->search.is_given_up) continue;
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
  find_steps({&contender});
  if (!contender.reason.empty()) return;
  measure_on_test({&contender});
}

/// What is learned at a step is the start for the next.
void recommendation::probe(candidate& contender, int k) {
  contender.step = grid_step(contender, k);
  const auto& thetas = contender.search.thetas;
  const auto nearest =
      std::ranges::min_element(thetas, {}, [&](const auto& known) { return std::abs(known.first - k); });
  if (nearest == thetas.end()) {
    prepare(contender);
  } else {
    prepare(contender, nearest->second, !contender.search.is_fine);
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
