// SPDX-License-Identifier: BSL-1.0
// The two-stage step on an ensemble: ours, what one writes by hand, Boost.Odeint, and the arithmetic
// alone.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "agree.hpp"
#include "counting.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "peers/roofs.hpp"
#include "peers/two_stage.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

constexpr double omega = 50.0;
constexpr double h = 0.01;
constexpr std::int64_t steps = 1000;
constexpr std::size_t blocks = 8;
constexpr std::size_t trajectories = blocks * pack<double>::lanes;
/// Rounding grows over 1000 steps, but not so far; beta1 off by 1e-4 ends 1e-5 away and more.
constexpr double rounding = 1e-9;

const fpu_chain<3> chain(omega);
constexpr std::array<double, 2> theta{0.5, 0.4};
const method learned = member(nystrom(), {theta[0], theta[1]});

two_stage folded() {
  const auto c = learned.coefficients();
  return {c[0] * h, c[1] * h, c[2] * h, c[3] * h, c[4] * h, 0.5 * omega * omega};
}

std::vector<chain_state<double>> single_starts() {
  const fpu_law<3> law(chain);
  std::vector<chain_state<double>> result(trajectories);
  for (std::size_t m = 0; m < trajectories; ++m) {
    const auto x = law(1, m);
    for (std::size_t i = 0; i < 6; ++i) {
      result[m].q[i] = x.q[static_cast<Eigen::Index>(i)];
      result[m].p[i] = x.p[static_cast<Eigen::Index>(i)];
    }
  }
  return result;
}

std::vector<chain_state<lanes>> lane_starts() {
  const auto singles = single_starts();
  std::vector<chain_state<lanes>> result(blocks);
  for (std::size_t m = 0; m < trajectories; ++m) {
    for (std::size_t i = 0; i < 6; ++i) {
      result[m / pack<double>::lanes].q[i].set(static_cast<int>(m % pack<double>::lanes), singles[m].q[i]);
      result[m / pack<double>::lanes].p[i].set(static_cast<int>(m % pack<double>::lanes), singles[m].p[i]);
    }
  }
  return result;
}

std::vector<double> numbers(std::span<const chain_state<double>> states) {
  std::vector<double> result;
  for (const auto& x : states) {
    result.insert(result.end(), x.q.begin(), x.q.end());
    result.insert(result.end(), x.p.begin(), x.p.end());
  }
  return result;
}
std::vector<double> numbers(std::span<const chain_state<lanes>> states) {
  std::vector<double> result;
  for (std::size_t m = 0; m < trajectories; ++m) {
    const auto& x = states[m / pack<double>::lanes];
    for (const auto& half : {x.q, x.p}) {
      for (const auto& one : half) result.push_back(one[static_cast<int>(m % pack<double>::lanes)]);
    }
  }
  return result;
}

/// By the library: the chain as a model.
void ours_by_library(std::span<chain_state<lanes>> states) {
  static const model system = chain;
  const auto stepper = make_stepper(system, learned, h);
  phase_point<lanes, Eigen::Dynamic> x{vector<lanes, Eigen::Dynamic>(6), vector<lanes, Eigen::Dynamic>(6)};
  for (auto& state : states) {
    std::copy(state.q.begin(), state.q.end(), x.q.begin());
    std::copy(state.p.begin(), state.p.end(), x.p.begin());
    auto run = stepper.open(x);
    stepper.advance(run, steps);
    const auto end = stepper.synchronous(run);
    std::copy(end.q.begin(), end.q.end(), state.q.begin());
    std::copy(end.p.begin(), end.p.end(), state.p.begin());
  }
}

/// The kernels do as many operations as our step, or they are no roof of it.
void require_operations() {
  const auto stepper = make_stepper(chain, learned, h);
  phase_point<counting, 6> x = fpu_law<3>(chain)(1, 0).cast<counting>();
  auto run = stepper.open(x);
  counting::multiplied = counting::added = 0;
  stepper.advance(run, 1);
  if (counting::multiplied == multiplications && counting::added == additions) return;
  throw std::runtime_error(fmt::format(
      "a two-stage step takes {} multiplications and {} additions, the kernels {} and {}: correct roofs.hpp",
      counting::multiplied, counting::added, multiplications, additions));
}

class entrants {
 public:
  entrants() {
    auto ends = lane_starts();
    ours<contraction::off>(ends, omega, theta, h, steps);
    ours_ = numbers(ends);
  }

  /// `run` steps all states from the starts on. Its end must be ours.
  template <class T>
  void add(const std::string& name, const std::vector<chain_state<T>>& starts, auto run,
           double tolerance = rounding) {
    auto ends = starts;
    run(std::span(ends));
    require_agreement(name, ours_, numbers(ends), tolerance);
    runners.push_back({name, static_cast<double>(trajectories * steps), [starts, run]() mutable {
                         auto states = starts;
                         run(std::span(states));
                         benchmark::DoNotOptimize(states.data());
                         benchmark::ClobberMemory();
                       }});
  }
  void add_kernel(const std::string& name, auto kernel) {
    const double work = static_cast<double>(trajectories * steps);
    runners.push_back({name, work, [kernel] { benchmark::DoNotOptimize(kernel(blocks * steps)); }});
  }

  std::vector<runner> runners;

 private:
  std::vector<double> ours_;
};

template <contraction Fused>
void add_all(entrants& all, const std::string& suffix) {
  const auto singles = single_starts();
  const auto packs = lane_starts();
  const two_stage c = folded();
  const double same_bits = Fused == contraction::off ? 0.0 : rounding;
  all.add(
      "ours" + suffix, packs, [](auto x) { ours<Fused>(x, omega, theta, h, steps); }, same_bits);
  all.add("hand-written" + suffix, packs, [c](auto x) { hand_written<Fused>(x, c, steps); });
  all.add("hand-written, folded" + suffix, packs, [c](auto x) { hand_folded<Fused>(x, c, steps); });
  all.add("odeint arrays" + suffix, singles, [c](auto x) { odeint_two_stage<Fused>(x, c, steps); });
  all.add("odeint arrays, merged" + suffix, singles, [c](auto x) { odeint_merged<Fused>(x, c, steps); });
  all.add("odeint packs" + suffix, packs, [c](auto x) { odeint_two_stage<Fused>(x, c, steps); });
  all.add("odeint packs, merged" + suffix, packs, [c](auto x) { odeint_merged<Fused>(x, c, steps); });
}

}  // namespace

void race_ensemble() {
  require_operations();
  entrants all;
  add_all<contraction::off>(all, "");
  add_all<contraction::on>(all, ", fused");
  all.add("ours, by the library", lane_starts(), ours_by_library, 0.0);
  all.add_kernel("same mix", mix_kernel<contraction::off>);
  all.add_kernel("fused multiply-adds", fma_kernel);
  race("ensemble", std::move(all.runners));
}

}  // namespace nysalt::bench
