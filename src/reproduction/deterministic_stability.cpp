// SPDX-License-Identifier: BSL-1.0
// Largest steps of the chain: section 5.2, after Figure 4.
#include <algorithm>
#include <cmath>

#include "comparison/stability.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

std::int64_t diverged(const std::vector<record>& runs) {
  return std::count_if(runs.begin(), runs.end(),
                       [](const record& run) { return run.diverged_at.has_value(); });
}

struct at_step {
  double step;
  std::vector<estimate> theta;
  bool usable;
  double limit;  // end of the first window of delta omega
  std::int64_t lost_by_learned, lost_by_fixed;
};

at_step stability_at(const setting& setup, const prepared_problem& system, double step, double horizon,
                     std::int64_t count) {
  const auto learned = learn_at(setup, system, step, usual_learning_setup(setup));
  const auto lost = [&](const method& method) {
    return diverged(followed(setup, system, method, step, horizon, horizon, count, {"stiff_energy"}));
  };
  return {step,
          theta_with_errors(learned),
          learned.fit.usable,
          limit_of(learned.method),
          lost(learned.method),
          lost(two_stages(0.5, 0.40))};
}

/// The last step at which no trajectory is lost, nor at any smaller step.
double largest(const std::vector<at_step>& all, std::int64_t at_step::*lost) {
  double last = 0.0;
  for (const auto& one : all) {
    if (one.*lost > 0) break;
    last = one.step;
  }
  return last;
}

}  // namespace

exhibit largest_stable_step(const setting& setup) {
  const auto system = chain();
  const auto count = setup.pick<std::int64_t>(64, 16);
  const double distance = setup.pick(0.001, 0.006);
  std::vector<at_step> all;
  for (double step = 0.038; step < 0.0605; step += distance) {
    const double rounded = std::round(step * 1e4) * 1e-4;
    const double horizon = rounded * std::ceil(setup.pick(150.0, 5.0) / rounded);
    all.push_back(stability_at(setup, *system, rounded, horizon, count));
  }
  table rows(
      {"delta", "b1", "beta1", "its linear limit/omega", "usable", "lost, learned", "lost, (0.5, 0.40)"}, 0);
  for (const auto& one : all) {
    rows.add({fmt::format("{:.3f}", one.step), with_error(one.theta[0]), with_error(one.theta[1]),
              fmt::format("{:.4f}", one.limit / omega), one.usable ? "yes" : "no",
              fmt::format("{}", one.lost_by_learned), fmt::format("{}", one.lost_by_fixed)});
  }
  const double limit = std::sqrt(20.0 / 3.0) / omega;
  const double learned = largest(all, &at_step::lost_by_learned);
  const double fixed = largest(all, &at_step::lost_by_fixed);
  const auto is_close = [&](double step) { return std::abs(step / limit - 1.0) <= 0.05; };
  const std::vector<reading> readings{{"parameters learned at each step", is_close(learned)},
                                      {"the fixed (0.5, 0.40)", is_close(fixed)}};
  return {"Largest stable step of the chain",
          "text after Figure 4, section 5.2",
          {{"stable beyond 2/omega, up to close to sqrt(20/3)/omega = 0.0516",
            "last step up to which no trajectory diverges by time 150",
            fmt::format("learned {:.3f}, fixed (0.5, 0.40) {:.3f}; steps are {:g} apart", learned, fixed,
                        distance),
            verdict_of("whether parameters are learned at each step", readings),
            summary_of(readings) + "; close: within 5 %",
            "nysalt stability --family nystrom --parameters 0.5,0.4 --system fpu --step 0.05"}},
          {fmt::format("{} trajectories to time 150. Learning here asks for linear stability at the chain's "
                       "frequencies; the parameters move with it, and with them the limit.",
                       count)},
          {{"Trajectories that are lost:", rows}},
          {}};
}

}  // namespace nysalt::program::paper
