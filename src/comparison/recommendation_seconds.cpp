// SPDX-License-Identifier: BSL-1.0
// Seconds of a step, and the steps that take equal seconds.
#include <algorithm>
#include <cmath>

#include "catalogue.hpp"
#include "recommendation.hpp"
#include "seconds.hpp"

namespace nysalt::program {

namespace {

method first_member(const std::string& family, std::optional<placement> where,
                    const prepared_problem& system) {
  const nysalt::family placed_family = placed(family, where, system.letters());
  return {placed_family.name,
          placed_family.letters,
          placed_family.coefficients(placed_family.starts.front().theta),
          {placed_family.order, placed_family.symmetric, placed_family.requires_quadratic_kinetic}};
}

}  // namespace

/// Of the steps only, far from where a method diverges: what they cost does not depend on the coefficients,
/// so that a family is timed before it is learned.
void recommendation::time_steps() {
  shown_.part("timing");
  const double small = 0.01 / rate_of_motion();  // of an evaluation
  constexpr std::int64_t steps = 256;            // beside which the first evaluation counts little
  std::vector<std::string> names;
  std::vector<timed_method> methods;
  std::erase_if(all_, [&](candidate& contender) {
    const double step = contender.source.evaluations_per_step * small;
    try {
      std::vector<std::string> ignored;
      const auto method = contender.is_learned()
                              ? first_member(*contender.source.family, contender.where, *system_)
                              : coefficients_at(contender.source, *system_, step, false,
                                                placement_asked(options_.placement), ignored);
      methods.push_back({method,
                         {step, steps, options_.trajectories, common_.seed, common_.execution.threads},
                         contender.source.evaluations_per_step / step});
      names.push_back(contender.source.typed);
      return false;
    } catch (const refusal& problem) {
      left_out_.emplace_back(contender.source.typed, problem.what());
      return true;
    }
  });
  constexpr double all_rounds = 2.0;
  const auto seconds = seconds_per_time(*system_, methods, all_rounds);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    timed_job one = seconds[i];
    one.least *= methods[i].plan.step;
    one.median *= methods[i].plan.step;
    step_seconds_[names[i]] = one;
  }
}

/// By how much repeated timings differ, relatively: half of them are within it of the least.
double recommendation::noise_of(const candidate& contender) const {
  const timed_job& one = step_seconds_.at(contender.source.typed);
  return one.median / one.least - 1.0;
}

/// At least what one evaluation more or less in a start makes, and compilers' layouts of code.
double recommendation::noise_of(const candidate& a, const candidate& b) const {
  constexpr double least = 0.05;
  return std::max(least, noise_of(a) + noise_of(b));
}

/// What takes as long at the step of the other contest, but for the noise of the clock, is taken from there.
contest recommendation::at_equal_seconds(double seconds_per_time, const contest* known) const {
  contest result{.unit = cost_unit::seconds,
                 .budget = seconds_per_time,
                 .cost_ratio = 1.0,
                 .statistic = statistic(false)};
  for (const candidate& planned : all_) {
    candidate contender = planned;
    const double of_steps = seconds_per_time - seconds_of_processing(contender);
    if (of_steps <= 0.0) {
      contender.reason = "the processor without the kernel takes longer";
      result.all.push_back(std::move(contender));
      continue;
    }
    contender.step = seconds_of_step(contender) / of_steps;
    if (known != nullptr) {
      const auto same = std::ranges::find_if(
          known->all, [&](const candidate& other) { return other.source.typed == contender.source.typed; });
      const bool is_there = same != known->all.end();
      if (is_there &&
          std::abs(std::log(contender.step / same->step)) <= noise_of(contender, *known->best())) {
        result.all.push_back(*same);
        continue;
      }
    }
    contender.method.reset();
    try {
      plan_at(contender.step, options_.trajectories, 0);
    } catch (const refusal& problem) {
      contender.reason = problem.what();
    }
    result.all.push_back(std::move(contender));
  }
  return result;
}

}  // namespace nysalt::program
