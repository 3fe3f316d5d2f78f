// SPDX-License-Identifier: BSL-1.0
// One run: what it refuses, when it is looked at, and when it is given up.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <vector>

#include "laws/models.hpp"
#include "laws/run_laws.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using point = phase_point<double, 1>;
using wrong = std::invalid_argument;

point at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }
const auto no_observer = [](auto&&...) {};

/// A force without a potential: q'' = q^3.
struct runaway {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = q[0] * q[0] * q[0]; }
};

/// The first step at which the state runs away, by looking at every one; -1 if none of them does.
template <SeparableSystem S, Method M>
std::int64_t first_bad_step(const S& system, const M& method, double step,
                            const phase_point<double, S::dimension>& x, std::int64_t steps) {
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  const auto runaway = [&](const auto& y) {
    if (!is_finite(y)) return true;
    if constexpr (HasEnergy<S>) {
      const double before = energy<double>(system, x);
      return !(std::abs(energy<double>(system, y) - before) <= 1e3 * std::max(std::abs(before), 1.0));
    }
    return false;
  };
  while (run.step < steps) {
    fixed.advance(run, 1);
    if (runaway(fixed.synchronous(run))) return run.step;
  }
  return -1;
}

template <SeparableSystem S, Method M>
void gives_up_in_time(const S& system, const M& method, double step,
                      const phase_point<double, S::dimension>& x) {
  const std::int64_t first = first_bad_step(system, method, step, x, 5000);
  BOOST_REQUIRE(first > 0);
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  fixed.advance(run, first);
  const auto bad = fixed.synchronous(run);
  // Numbers are equal, or no numbers both.
  const auto same = [](const auto& a, const auto& b) {
    return std::ranges::equal(a, b, [](double u, double v) { return u == v || (u != u && v != v); });
  };
  for (const std::int64_t every : {1, 2, 7, 64, 100, 5000}) {
    std::int64_t last_seen = -1;
    const auto observe = [&](std::int64_t n, double, const auto&) { last_seen = n; };
    const auto end = integrate(system, method, step, x, 5000, observe, every);
    BOOST_TEST_CONTEXT("every " << every) {
      BOOST_REQUIRE(end.diverged_at.has_value());
      BOOST_TEST(*end.diverged_at == first);
      BOOST_TEST(end.steps == first);
      BOOST_TEST((same(end.finish.q, bad.q) && same(end.finish.p, bad.p)));
      BOOST_TEST(last_seen == (first - 1) / every * every);  // no observer sees the bad state
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const pendulum system;
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto run = [&](const point& x, std::int64_t steps, std::int64_t every) {
    integrate(system, verlet(), 0.1, x, steps, no_observer, every);
  };
  BOOST_TEST(refuses<wrong>([&] { run(at(0, 0), -1, 1); }, {"integrate", "steps -1"}));
  BOOST_TEST(refuses<wrong>([&] { run(at(0, 0), 10, 0); }, {"integrate", "every 0"}));
  BOOST_TEST(refuses<wrong>([&] { run(at(0, 0), 10, -3); }, {"integrate", "every -3"}));
  BOOST_TEST(refuses<wrong>([&] { run(at(not_a_number, 0), 10, 1); }, {"start", "finite", "dimension"}));
  BOOST_TEST(refuses<wrong>([&] { integrate(system, verlet(), 0.0, at(0, 0), 1); }, {"step", "not zero"}));
  const auto chain = a_dynamic_fpu::make();
  const phase_point<double, Eigen::Dynamic> short_one{Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3)};
  const phase_point<double, Eigen::Dynamic> uneven{Eigen::VectorXd::Zero(4), Eigen::VectorXd::Zero(3)};
  BOOST_TEST(refuses<wrong>([&] { integrate(chain, verlet(), 0.1, short_one, 1); }, {"dimension"}));
  BOOST_TEST(refuses<wrong>([&] { integrate(chain, verlet(), 0.1, uneven, 1); }, {"dimension"}));
}

BOOST_AUTO_TEST_CASE(no_steps_end_where_they_start) {
  const auto end = integrate(pendulum(), verlet(), 0.1, at(1, 2), 0);
  BOOST_TEST(end.steps == 0);
  BOOST_TEST(!end.diverged_at.has_value());
  BOOST_TEST(distance(end.finish, at(1, 2)) <= 2.0 * eps);  // the first letter is taken back, to rounding
}

BOOST_AUTO_TEST_CASE(the_observer_is_called_every_so_often_with_the_synchronous_state) {
  const pendulum system;
  const auto fixed = make_stepper(system, verlet(), 0.1);
  std::vector<std::int64_t> seen;
  auto run = fixed.open(at(1, 0));
  const auto observe = [&](std::int64_t n, double t, const point& x) {
    seen.push_back(n);
    BOOST_TEST(t == static_cast<double>(n) * 0.1);
    if (n == 0) {
      BOOST_TEST(same_bits(x, at(1, 0)));  // the start itself
      return;
    }
    fixed.advance(run, n - run.step);
    BOOST_TEST(same_bits(x, fixed.synchronous(run)));
  };
  const auto end = integrate(system, verlet(), 0.1, at(1, 0), 200, observe, 75);
  BOOST_TEST((seen == std::vector<std::int64_t>{0, 75, 150}));
  BOOST_TEST(end.steps == 200);
  fixed.advance(run, 50);
  BOOST_TEST(same_bits(end.finish, fixed.synchronous(run)));
}

BOOST_AUTO_TEST_CASE(divergence_is_named_by_its_first_step_whoever_looks) {
  gives_up_in_time(harmonic_oscillator(1.0), verlet(), 2.001, at(1, 0));  // by its energy
  gives_up_in_time(harmonic_oscillator(1.0), mclachlan2(), 2.6, at(1, 0));
  gives_up_in_time(fpu_chain<3>(50.0), verlet(), 0.05,
                   {vector<double, 6>::Constant(0.1), vector<double, 6>::Ones()});
}

BOOST_AUTO_TEST_CASE(a_passing_excursion_is_judged_the_same_whoever_looks) {
  // Just inside Verlet's limit the energy swings by more than 1e3 and comes back.
  const harmonic_oscillator system(1.0);
  const auto unobserved = integrate(system, verlet(), 1.9991, at(0, 2), 10000);
  BOOST_TEST(first_bad_step(system, verlet(), 1.9991, at(0, 2), 10000) > 0);
  for (const std::int64_t every : {1, 50, 64, 100, 10000}) {
    const auto end = integrate(system, verlet(), 1.9991, at(0, 2), 10000, no_observer, every);
    BOOST_TEST((end.diverged_at == unobserved.diverged_at));
    BOOST_TEST(same_bits(end.finish, unobserved.finish));
  }
}

BOOST_AUTO_TEST_CASE(without_an_energy_only_what_is_not_finite_diverges) {
  gives_up_in_time(runaway(), verlet(), 0.1, at(1, 1));
}

BOOST_AUTO_TEST_CASE(what_is_stable_is_not_given_up) {
  BOOST_TEST(first_bad_step(harmonic_oscillator(1.0), verlet(), 1.99, at(1, 0), 5000) == -1);
  BOOST_TEST(!integrate(harmonic_oscillator(1.0), verlet(), 1.99, at(1, 0), 5000).diverged_at.has_value());
}
