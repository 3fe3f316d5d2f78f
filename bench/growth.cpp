// SPDX-License-Identifier: BSL-1.0
// What a step costs as the ensemble grows, and as the chain grows.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "chain_run.hpp"
#include "ensemble_run.hpp"
#include "peers/textbook_chain.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

/// A hundred steps from state to state, as in making data or observing now and then.
runner ensemble_of(std::int64_t trajectories) {
  constexpr std::int64_t steps = 100;
  const auto all = std::make_shared<states>(starts_of(trajectories));
  return {fmt::format("{}", trajectories), static_cast<double>(trajectories * steps),
          [all] { run_ensemble(*all, steps, 1); }};
}

/// A hundred steps or more: steps between observations, not observing.
std::int64_t steps_of_turn(Eigen::Index masses) { return std::max<std::int64_t>(100, 1'000'000 / masses); }

runner chain_of(Eigen::Index masses) {
  const auto chain = std::make_shared<model>(chain_model(masses));
  const auto opened = make_stepper(*chain, verlet{}, chain_step).open(start_of_chain(masses));
  const auto run = std::make_shared<open_run<double, Eigen::Dynamic>>(opened);
  const std::int64_t steps = steps_of_turn(masses);
  return {fmt::format("{}", masses), static_cast<double>(masses * steps),
          [chain, run, steps] { make_stepper(*chain, verlet{}, chain_step).advance(*run, steps); }};
}

runner stream_of(Eigen::Index masses) {
  const auto x = std::make_shared<chain_point>(start_of_chain(masses));
  const std::int64_t steps = steps_of_turn(masses);
  return {fmt::format("stream {}", masses), static_cast<double>(masses * steps),
          [x, steps] { stream<contraction::off>(numbers(x->q), numbers(x->p), 1.0, steps); }};
}

}  // namespace

void race_growth() {
  std::vector<runner> ensembles;
  for (const std::int64_t n : {1'000, 10'000, 100'000, 1'000'000}) ensembles.push_back(ensemble_of(n));
  race("growing ensemble", std::move(ensembles));

  std::vector<runner> chains;
  for (const Eigen::Index n : {1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000}) {
    chains.push_back(chain_of(n));
    chains.push_back(stream_of(n));
  }
  race("growing chain", std::move(chains));
}

}  // namespace nysalt::bench
