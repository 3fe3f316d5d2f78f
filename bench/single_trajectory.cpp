// SPDX-License-Identifier: BSL-1.0
// One trajectory with Verlet's method: nothing to put side by side, so that latency counts.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "agree.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "peers/two_stage.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr double omega = 50.0;
constexpr double k = 0.5 * omega * omega;
constexpr double h = 0.01;
constexpr std::int64_t steps = 20'000;

const fpu_chain<3> chain(omega);

chain_state<double> start() {
  const auto x = fpu_law<3>(chain)(1, 0);
  chain_state<double> result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.q[i] = x.q[static_cast<Eigen::Index>(i)];
    result.p[i] = x.p[static_cast<Eigen::Index>(i)];
  }
  return result;
}

template <class S>
chain_state<double> ours(const S& system, const method& method, std::int64_t count) {
  const auto stepper = make_stepper(system, method, h);
  const auto from = fpu_law<3>(chain)(1, 0);
  auto run = stepper.open(phase_point<double, S::dimension>{from.q, from.p});
  stepper.advance(run, count);
  const auto x = stepper.synchronous(run);
  chain_state<double> result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.q[i] = x.q[static_cast<Eigen::Index>(i)];
    result.p[i] = x.p[static_cast<Eigen::Index>(i)];
  }
  return result;
}

/// After 1000 steps: later trajectories that differ by rounding part.
void require_same(const char* what, const chain_state<double>& a, const chain_state<double>& b) {
  require_agreement(what, a.q, b.q, 1e-9);
  require_agreement(what, a.p, b.p, 1e-9);
}

template <contraction Fused>
void add_peers(std::vector<runner>& runners, const std::string& suffix) {
  const auto add = [&](const std::string& name, auto step, const auto& method) {
    auto x = start();
    step(x, std::int64_t{1000});
    require_same((name + suffix).c_str(), ours(chain, method, 1000), x);
    runners.push_back({name + suffix, static_cast<double>(steps), [step] {
                         auto state = start();
                         step(state, steps);
                         benchmark::DoNotOptimize(state);
                       }});
  };
  add(
      "odeint velocity_verlet", [](auto& x, std::int64_t n) { odeint_verlet<Fused>(x, k, h, n); }, verlet{});
  add(
      "odeint Nystrom stepper", [](auto& x, std::int64_t n) { odeint_verlet_aba<Fused>(x, k, h, n); },
      verlet_aba{});
}

}  // namespace

void race_single_trajectory() {
  std::vector<runner> runners;
  runners.push_back({"ours", static_cast<double>(steps), [] {
                       auto state = ours(chain, verlet{}, steps);
                       benchmark::DoNotOptimize(state);
                     }});
  static const model by_library = chain;
  runners.push_back({"ours, by the library", static_cast<double>(steps), [] {
                       auto state = ours(by_library, verlet{}, steps);
                       benchmark::DoNotOptimize(state);
                     }});
  add_peers<contraction::off>(runners, "");
  add_peers<contraction::on>(runners, ", fused");
  race("single trajectory", std::move(runners));
}

}  // namespace nysalt::bench
