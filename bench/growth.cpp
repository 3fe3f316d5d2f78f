// SPDX-License-Identifier: BSL-1.0
// What a step costs as the ensemble grows, and as the chain grows.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "peers/textbook_chain.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr double omega = 50.0;
constexpr double h = 0.01;
using lanes = pack<double, default_lanes>;

void add_ensemble(std::vector<runner>& runners, std::int64_t trajectories) {
  static const fpu_chain<3> chain(omega);
  constexpr std::int64_t steps = 100;
  const std::int64_t blocks = trajectories / default_lanes;
  auto states = std::make_shared<std::vector<phase_point<lanes, 6>>>(blocks);
  for (auto& x : *states)
    for (int i = 0; i < 6; ++i) {
      x.q[i] = lanes(0.01 * i);
      x.p[i] = lanes(0.1);
    }
  runners.push_back(
      {fmt::format("{}", trajectories), static_cast<double>(blocks * default_lanes * steps), [=] {
         const auto stepper = make_stepper(chain, member<nystrom>({0.5, 0.4}), h);
         for (auto& x : *states) {
           auto run = stepper.open(x);
           stepper.advance(run, steps);
           x = stepper.synchronous(run);
         }
       }});
}

void add_chain(std::vector<runner>& runners, Eigen::Index masses) {
  const auto chain = std::make_shared<fpu_chain<>>(masses / 2, omega);
  phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd(masses), Eigen::VectorXd(masses)};
  for (Eigen::Index i = 0; i < masses; ++i) {
    x.q[i] = 0.1 * std::sin(0.7 * static_cast<double>(i / 2));
    x.p[i] = 0.1 * std::cos(0.3 * static_cast<double>(i));
  }
  const auto stepper = make_stepper(*chain, verlet{}, h);
  auto run = std::make_shared<open_run<double, Eigen::Dynamic>>(stepper.open(x));
  const std::int64_t steps = std::max<std::int64_t>(1, 1'000'000 / masses);
  runners.push_back({fmt::format("{}", masses), static_cast<double>(masses * steps),
                     [=] { make_stepper(*chain, verlet{}, h).advance(*run, steps); }});
  auto y = std::make_shared<phase_point<double, Eigen::Dynamic>>(x);
  runners.push_back(
      {fmt::format("stream {}", masses), static_cast<double>(masses * steps), [=] {
         stream<contraction::off>({y->q.data(), (size_t)masses}, {y->p.data(), (size_t)masses}, 1.0, steps);
       }});
}

}  // namespace

void race_growth() {
  std::vector<runner> runners;
  for (const std::int64_t n : {1'000, 10'000, 100'000, 1'000'000}) add_ensemble(runners, n);
  race("growing ensemble", std::move(runners));
  runners.clear();
  for (const Eigen::Index n : {1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000})
    add_chain(runners, n);
  race("growing chain", std::move(runners));
}

}  // namespace nysalt::bench
