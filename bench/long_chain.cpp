// SPDX-License-Identifier: BSL-1.0
// A chain of a thousand masses against the textbook's loop.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

#include "agree.hpp"
#include "chain_run.hpp"
#include "peers/textbook_chain.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr Eigen::Index masses = 1000;
constexpr std::int64_t steps = 1000;

chain_point ours(std::int64_t count) {
  const model chain = chain_model(masses);
  const auto stepper = make_stepper(chain, verlet{}, chain_step);
  auto run = stepper.open(start_of_chain(masses));
  stepper.advance(run, count);
  return stepper.synchronous(run);
}

template <contraction Fused>
chain_point textbook(std::int64_t count) {
  auto x = start_of_chain(masses);
  Eigen::VectorXd f(masses);
  constexpr double k = 0.5 * chain_omega * chain_omega;
  textbook_chain<Fused>(numbers(x.q), numbers(x.p), numbers(f), k, chain_step, count);
  return x;
}

void add(std::vector<runner>& runners, const std::string& name, auto run) {
  const auto expected = ours(100);
  const auto found = run(std::int64_t{100});
  require_agreement(name, numbers(expected.q), numbers(found.q), 1e-10);
  require_agreement(name, numbers(expected.p), numbers(found.p), 1e-10);
  runners.push_back({name, static_cast<double>(masses * steps), [run] {
                       auto end = run(steps);
                       benchmark::DoNotOptimize(end.q.data());
                       benchmark::ClobberMemory();
                     }});
}

}  // namespace

void race_long_chain() {
  std::vector<runner> runners;
  add(runners, "ours", ours);
  add(runners, "textbook", textbook<contraction::off>);
  add(runners, "textbook, fused", textbook<contraction::on>);
  race("long chain", std::move(runners));
}

}  // namespace nysalt::bench
