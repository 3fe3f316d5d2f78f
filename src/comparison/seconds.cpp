// SPDX-License-Identifier: BSL-1.0
#include "seconds.hpp"

#include <algorithm>
#include <cmath>

#include "all_ranks.hpp"
#include "kept_answers.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/communicator.hpp"

namespace nysalt::program {

namespace {

/// In turns, so that a machine that slows down slows all; each job is long enough for the clock.
std::vector<timed_job> timed(const prepared_problem& system, const std::vector<timed_method>& methods,
                             double seconds) {
  constexpr double job = 1e-3;
  constexpr std::int64_t most_trajectories = 64;
  std::vector<std::function<void()>> jobs;
  std::vector<double> simulated;
  double round = 0.0;
  for (const auto& [method, whole, evaluations_per_time] : methods) {
    trajectories_plan plan = whole;
    const double time = static_cast<double>(plan.steps) * plan.step;
    const double wanted = std::max(1.0, std::floor(1e5 / (evaluations_per_time * time)));
    const double count = std::min(wanted, static_cast<double>(std::min(plan.count, most_trajectories)));
    const std::int64_t lanes = system.lanes();  // all of them full, as in a large ensemble
    plan.count = (static_cast<std::int64_t>(count) + lanes - 1) / lanes * lanes;
    const auto once = system.timed_run(method, plan);
    const double taken = interleaved_seconds({once}, 1).front().least;
    const double repeats = std::max(1.0, std::ceil(job / std::max(taken, 1e-9)));
    jobs.emplace_back([once, repeats] {
      for (double n = 0.0; n < repeats; ++n) once();
    });
    simulated.push_back(time * static_cast<double>(plan.count) * repeats);
    round += taken * repeats;
  }
  const int rounds = static_cast<int>(std::clamp(seconds / round, 3.0, 15.0));
  auto result = interleaved_seconds(jobs, rounds);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].least /= simulated[i];
    result[i].median /= simulated[i];
  }
  return result;
}

}  // namespace

std::vector<timed_job> seconds_per_time(const prepared_problem& system,
                                        const std::vector<timed_method>& methods, double seconds) {
  json question{"seconds"};
  for (const auto& one : methods)
    question.push_back({one.method.letters().letters(), one.method.coefficients(), one.plan.step});
  return once<std::vector<timed_job>>(system.answers(), question, [&] {
    std::vector<timed_job> result;
    on_first(all_ranks(), [&] { result = timed(system, methods, seconds); });
    broadcast(all_ranks(), result);
    return result;
  });
}

}  // namespace nysalt::program
