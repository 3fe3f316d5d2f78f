// SPDX-License-Identifier: BSL-1.0
// A chain of a thousand masses against the textbook's loop.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "agree.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "peers/textbook_chain.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

using state = phase_point<double, Eigen::Dynamic>;

std::span<const double> all(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
std::span<double> all(Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

constexpr double omega = 50.0;
constexpr double k = 0.5 * omega * omega;
constexpr double h = 0.01;
constexpr Eigen::Index masses = 1000;
constexpr std::int64_t steps = 1000;

const fpu_chain<> chain(masses / 2, omega);

state start() {
  state x{Eigen::VectorXd(masses), Eigen::VectorXd(masses)};
  for (Eigen::Index i = 0; i < masses; ++i) {
    x.q[i] = 0.1 * std::sin(0.7 * static_cast<double>(i / 2));
    x.p[i] = 0.1 * std::cos(0.3 * static_cast<double>(i));
  }
  return x;
}

state ours(std::int64_t count) {
  const auto stepper = make_stepper(chain, verlet{}, h);
  auto run = stepper.open(start());
  stepper.advance(run, count);
  return stepper.synchronous(run);
}

template <contraction Fused>
state textbook(std::int64_t count) {
  auto x = start();
  std::vector<double> f(static_cast<std::size_t>(masses));
  textbook_chain<Fused>(all(x.q), all(x.p), f, k, h, count);
  return x;
}

void add(std::vector<runner>& runners, const std::string& name, auto run) {
  const auto expected = ours(100);
  const auto found = run(std::int64_t{100});
  require_agreement(name, all(expected.q), all(found.q), 1e-10);
  require_agreement(name, all(expected.p), all(found.p), 1e-10);
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
