// SPDX-License-Identifier: BSL-1.0
// An ensemble on two threads against one; beside it a kernel that shares nothing, which tells whether the
// machine has two processors to give.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "agree.hpp"
#include "ensemble_run.hpp"
#include "peers/roofs.hpp"
#include "races.hpp"

namespace nysalt::bench {

void race_threads() {
  constexpr std::int64_t trajectories = 4096;
  constexpr std::int64_t steps = 2000;
  const auto starts = std::make_shared<states>(starts_of(trajectories));
  states ends = *starts;
  run_ensemble(ends, steps, 1);
  states others = *starts;
  run_ensemble(others, steps, 2);
  require_agreement("the ensemble on two threads", numbers(ends), numbers(others), 0.0);

  std::vector<runner> runners;
  for (const int threads : {1, 2}) {
    runners.push_back({threads == 1 ? "one thread" : "two threads", static_cast<double>(trajectories * steps),
                       [starts, threads] {
                         states x = *starts;
                         run_ensemble(x, steps, threads);
                         benchmark::DoNotOptimize(x.data());
                       }});
  }
  constexpr std::int64_t kernel_steps = trajectories * steps / default_lanes;
  const auto kernel = [](std::int64_t count) {
    benchmark::DoNotOptimize(mix_kernel<contraction::off>(count));
  };
  const double work = static_cast<double>(trajectories * steps);
  runners.push_back({"kernel, one thread", work, [=] { kernel(kernel_steps); }});
  runners.push_back({"kernel, two threads", work, [=] {
                       std::jthread other([=] { kernel(kernel_steps / 2); });
                       kernel(kernel_steps / 2);
                     }});
  race("threads", std::move(runners), {.turn_seconds = 0.02, .clock = clock_kind::wall});
}

}  // namespace nysalt::bench
