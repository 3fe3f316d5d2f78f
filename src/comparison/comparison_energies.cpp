// SPDX-License-Identifier: BSL-1.0
// Stability in a report: the judgement of each step, and energies and survivors along time.
#include <algorithm>
#include <cmath>
#include <string>

#include "comparison.hpp"
#include "nysalt/stepping/served_letters.hpp"
#include "sampled_run.hpp"

namespace nysalt::program {

namespace {

/// Root mean square energy error and share of surviving trajectories at each sample. A record holds the
/// energy only, sampled every `between` units of time; the record of a trajectory that diverges is shorter.
energy_course course_of(const std::vector<record>& all, double between) {
  energy_course result;
  std::size_t longest = 0;
  for (const record& one : all) longest = std::max(longest, one.values.size());
  for (std::size_t i = 0; i < longest; ++i) {
    double squares = 0.0;
    double alive = 0.0;
    for (const record& one : all) {
      if (i >= one.values.size()) continue;
      squares += std::pow(one.values[i] - one.values.front(), 2.0);
      ++alive;
    }
    result.t.push_back(between * static_cast<double>(i));
    result.deviation.push_back(std::sqrt(squares / alive));
    result.surviving.push_back(alive / static_cast<double>(all.size()));
  }
  return result;
}

}  // namespace

void comparison::judge_steps() {
  for (row& line : rows_) {
    if (!line.coefficients) continue;
    shown_.part(fmt::format("judging {} at step {:g}", line.method, line.nominal));
    // A step of several evaluations is a product, which differs from the step as typed in its last digit.
    const double as_typed = std::stod(fmt::format("{:.15g}", line.step));
    line.judged = system_->judged(*line.coefficients, as_typed, common_.execution.threads);
  }
}

/// Of the first trajectories of the test, at some forty times.
void comparison::follow_energies(work_file& kept) {
  constexpr std::int64_t most_trajectories = 64;
  constexpr std::int64_t samples = 40;
  for (row& line : rows_) {
    if (!line.reason.empty()) continue;
    shown_.part(fmt::format("energies of {} at step {:g}", line.method, line.nominal));
    const std::string part = fmt::format("energies of {} at {}", line.method, line.step);
    line.energies = kept.once(part, from_json<energy_course>, [&] {
      sampled_plan plan{.trajectories = plan_at(line.step), .observables = {"energy"}};
      plan.trajectories.count = std::min(plan.trajectories.count, most_trajectories);
      plan.every = std::max<std::int64_t>(1, plan.trajectories.steps / samples);
      std::vector<record> all;
      const auto take = [&](std::int64_t, const record& one) { all.push_back(one); };
      run(*system_, *line.coefficients, plan, take, {});
      return course_of(all, line.step * static_cast<double>(plan.every));
    });
  }
}

}  // namespace nysalt::program
