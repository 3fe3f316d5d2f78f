// SPDX-License-Identifier: BSL-1.0
// Long runs of the merged loop sample the law that a step keeps by the Lyapunov equation.
#include <boost/test/unit_test.hpp>

#include "../support/langevin_methods.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/noises/counter_noise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using moments = Eigen::Array3d;  // of q^2, q p, p^2

/// What is forgotten of the start after 100 steps of z = 1.2, g = .5 is e^{-60} of a variance.
constexpr damped_oscillator oscillator{3.0, 1.5, 0.8};
constexpr double step = 0.4;
constexpr std::int64_t forgotten = 100;

/// Means over the trajectories of their means over the times, and the standard errors.
struct sampled {
  moments mean, standard_error;
};
template <class Noise>
sampled sample(const Method auto& method, const Noise& noise) {
  constexpr std::int64_t trajectories = 8192;
  constexpr std::int64_t steps = 300;
  constexpr std::int64_t every = 4;
  using T = pack<double>;
  const auto system = bathed_system(oscillator);
  const auto stepper = make_stepper(system, method, step, noise);
  std::vector<moments> of;
  for (std::uint64_t first = 0; first < trajectories; first += lanes_in<T>) {
    auto run = stepper.open(point(0.0, 0.0).cast<T>(), first);
    std::array<T, 3> sums{T(0.0), T(0.0), T(0.0)};
    stepper.advance(run, steps, every, [&](std::int64_t n, const phase_point<T, 1>& x) {
      if (n <= forgotten) return;
      sums[0] += x.q[0] * x.q[0];
      sums[1] += x.q[0] * x.p[0];
      sums[2] += x.p[0] * x.p[0];
    });
    for (int k = 0; k < lanes_in<T>; ++k) {
      constexpr double looks = (steps - forgotten) / every;
      of.push_back(moments(sums[0][k], sums[1][k], sums[2][k]) / looks);
    }
  }
  moments sum = moments::Zero();
  moments squares = moments::Zero();
  for (const moments& x : of) {
    sum += x;
    squares += x * x;
  }
  const double n = trajectories;
  const moments mean = sum / n;
  return {mean, ((squares / n - mean * mean) / n).sqrt()};
}

/// The largest of three differences from the Lyapunov equation, in standard errors.
double off(const Method auto& method, const sampled& run) {
  const square<2> law = stationary(word_step(oscillator, spell(method), step));
  return ((run.mean - moments(law(0, 0), law(0, 1), law(1, 1))) / run.standard_error).abs().maxCoeff();
}

/// Numbers that are too large by a part of them.
struct too_loud {
  static constexpr bool is_memoryless = true;
  counter_noise source;
  double by;
  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    source.normals(at, xi);
    for (auto& x : xi) x = x * by;
  }
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    source.halving(at, zeta);
  }
};

}  // namespace

// 8 methods, three moments each.
constexpr double rate_of_moment = false_alarms / 24;
BOOST_AUTO_TEST_CASE_TEMPLATE(long_runs_sample_the_law_that_a_step_keeps, M, langevin_methods) {
  const auto run = sample(M(), counter_noise(seed(20260721)));
  BOOST_TEST_MESSAGE(M().name() << ": " << off(M(), run) << " standard errors of "
                                << (run.standard_error / run.mean).transpose());
  BOOST_TEST_CONTEXT(M().name()) { BOOST_TEST(off(M(), run) <= standard_errors(rate_of_moment)); }
}

// Noise that is 2 % too large adds 4 % to the variances, whose standard errors are 0.2 %.
// q and p as somebody sees them.
BOOST_AUTO_TEST_CASE(a_wrong_deviation_is_noticed) {
  BOOST_TEST(off(baoab(), sample(baoab(), too_loud{counter_noise(seed(1)), 1.02})) >
             standard_errors(rate_of_moment));
  BOOST_TEST(off(obabo(), sample(obabo(), too_loud{counter_noise(seed(1)), 1.02})) >
             standard_errors(rate_of_moment));
}
