// SPDX-License-Identifier: BSL-1.0
// An ensemble on two threads against one; beside it a kernel that shares nothing, which tells whether the
// machine has two processors to give.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "agree.hpp"
#include "chain_run.hpp"
#include "ensemble_run.hpp"
#include "peers/roofs.hpp"
#include "peers/textbook_chain.hpp"
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
  constexpr std::int64_t kernel_steps = trajectories * steps / pack<double>::lanes;
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

/// One trajectory of a long chain on one thread and on two, beside the textbook's loop, and beside a loop
/// that only moves q and p.
void race_one_chain() {
  for (const Eigen::Index masses : {1'000'000, 10'000'000}) {
    const std::int64_t steps = 100'000'000 / masses;
    const double work = static_cast<double>(masses * steps);
    const auto start = std::make_shared<chain_point>(start_of_chain(masses));
    const auto f = std::make_shared<Eigen::VectorXd>(masses);
    // Open runs that go on from turn to turn: a turn that made its vectors anew would time the system's fresh
    // pages.
    const auto tiles = [start, steps](int threads) {
      const auto chain = std::make_shared<const model>(chain_model(start->q.size()).on_threads(threads));
      const auto opened = make_stepper(*chain, verlet{}, chain_step).open(*start);
      const auto run = std::make_shared<open_run<double, Eigen::Dynamic>>(opened);
      return [chain, run, steps] {
        make_stepper(*chain, verlet{}, chain_step).advance(*run, steps);
        return numbers(std::as_const(run->state.q));
      };
    };
    const auto one = tiles(1);
    const auto two = tiles(2);
    require_agreement("a chain on two threads", one(), two(), 0.0);
    std::vector<runner> runners{{"one thread", work, [=] { benchmark::DoNotOptimize(one().data()); }},
                                {"two threads", work, [=] { benchmark::DoNotOptimize(two().data()); }}};
    const auto plain = std::make_shared<chain_point>(*start);
    runners.push_back({"textbook", work, [=] {
                         constexpr double k = 0.5 * chain_omega * chain_omega;
                         textbook_chain<contraction::off>(numbers(plain->q), numbers(plain->p), numbers(*f),
                                                          k, chain_step, steps);
                         benchmark::DoNotOptimize(plain->q.data());
                       }});
    const auto move = [steps](std::span<double> q, std::span<double> p) {
      stream<contraction::off>(q, p, 1.0, steps);
    };
    const auto x = std::make_shared<chain_point>(*start);
    runners.push_back({"moving the data, one thread", work, [=] { move(numbers(x->q), numbers(x->p)); }});
    runners.push_back({"moving the data, two threads", work, [=] {
                         const std::size_t half = static_cast<std::size_t>(masses) / 2;
                         std::jthread other(
                             [=] { move(numbers(x->q).first(half), numbers(x->p).first(half)); });
                         move(numbers(x->q).last(half), numbers(x->p).last(half));
                       }});
    race(masses == 1'000'000 ? "one chain of 10^6" : "one chain of 10^7", std::move(runners),
         {.turn_seconds = 0.0, .clock = clock_kind::wall});
  }
}

}  // namespace nysalt::bench
