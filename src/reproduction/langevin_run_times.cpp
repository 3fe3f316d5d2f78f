// SPDX-License-Identifier: BSL-1.0
// Run times, section 5.3.
#include <chrono>
#include <functional>
#include <optional>

#include "comparison/seeds.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

double seconds_of(const std::function<void()>& job) {
  const auto start = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

exhibit run_times(const setting& setup) {
  const prepared_problem& system = setup.in_bath("gibbs");
  constexpr double step = 190.0 * gap_step;
  std::optional<learned_scheme> learned;
  const double learning = seconds_of([&] {
    learned = learn_at(setup, system, step,
                       {.trajectories = setup.pick<std::int64_t>(512, 16),
                        .horizon = 1.0,
                        .where = placement::end,
                        .fine_step = gap_step});
  });
  // Of the steps only; as many trajectories of fine steps as take a moment, the time is proportional.
  const auto seconds = [&](const method& method, double step_size, std::int64_t count) {
    const auto job = system.timed_run(method, {step_size, static_cast<std::int64_t>(40.0 / step_size), count,
                                               seed_for(role::test, setup.seed()), 1});
    return seconds_of(job) * 10'000.0 / static_cast<double>(count);
  };
  const double fine = seconds(classical("baoab", system), gap_step, setup.pick<std::int64_t>(320, 16));
  const double coarse = seconds(learned->method, step, setup.pick<std::int64_t>(10'000, 320));
  const double half_baoab =
      seconds(classical("baoab", system), 0.5 * step, setup.pick<std::int64_t>(10'000, 320));
  const double factor = fine / coarse;
  table rows({"job", "paper, s", "ours, s"});
  rows.add({"BAOAB, h = 1e-4, 10^4 trajectories to T = 40", "2078", fmt::format("{:.3g}", fine)});
  rows.add({"NySALT, gap 190, the same", "18", fmt::format("{:.3g}", coarse)});
  rows.add({"BAOAB, gap 95, the same force evaluations", "", fmt::format("{:.3g}", half_baoab)});
  rows.add({"learning at gap 190", "854", fmt::format("{:.3g}", learning)});
  const std::vector<reading> readings{{"steps of h = 1e-4", factor >= 85.0},
                                      {"BAOAB at equal force evaluations", half_baoab / coarse >= 85.0}};
  return {
      "Run times",
      "section 5.3",
      {{"NySALT at gap 190 is almost 115 times faster than BAOAB with fine steps (2078 s and 18 s)",
        "ratio of seconds for 10^4 trajectories to T = 40, one core",
        fmt::format("{:.3g} to fine steps, {:.2f} to BAOAB with half the step", factor, half_baoab / coarse),
        verdict_of("what it is compared with", readings),
        summary_of(readings) + "; at least three quarters of 115. 190 fine steps are replaced by one of two "
                               "evaluations: a factor "
                               "of 95 by counting",
        "nysalt compare --system fpu --friction 0.01 --sigma 0.05 --steps 0.019 --methods "
        "baoab,learned:nystrom@end"},
       {"learning takes 854 s", "seconds of learning from M = 512, data included",
        fmt::format("{:.2g}", learning), verdict_of(learning > 427.0 && learning < 1708.0),
        "within a factor of two; faster by a factor of " + fmt::format("{:.0f}", 854.0 / learning),
        "nysalt learn --system fpu --friction 0.01 --sigma 0.05 --placement end --trajectories 512 --horizon "
        "1 --step 0.019"}},
      {fmt::format("Fine steps are timed on {} trajectories and scaled.", setup.pick(320, 16))},
      {{"Seconds:", rows}},
      {}};
}

}  // namespace nysalt::program::paper
