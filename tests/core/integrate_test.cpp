// SPDX-License-Identifier: BSL-1.0
// One run: what it refuses, when it is looked at, and when it is given up. That trajectories side by side go
// as each would alone, also where one diverges, is in data/ensembles_test.cpp.
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include "../laws/laws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/references/odeint_stepper.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using point = phase_point<double, 1>;
using state = phase_point<double, Eigen::Dynamic>;

point at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }
state one(double q, double p) { return {Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, p)}; }
const auto no_observer = [](auto&&...) {};
const tabulated by_verlet{verlet()};
const model oscillator = harmonic_oscillator(1.0);
const model chain = fpu_chain<3>(50.0);

/// A force without a potential: q'' = q^3.
struct runaway {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = q[0] * q[0] * q[0]; }
};

/// The first step at which the state runs away, by looking at every one; -1 if none of them does.
std::int64_t first_bad_step(const model& system, const tabulated& method, double step, const state& x,
                            std::int64_t steps) {
  const auto fixed = make_stepper(system, method, step);
  auto run = fixed.open(x);
  double scale = 0.0;
  if (has_energy(system)) {
    auto at_rest = x;
    at_rest.p.setZero();
    const double potential = energy<double>(system, at_rest);
    at_rest.q *= 1.0 + 0x1p-10;
    scale = std::max({std::abs(energy<double>(system, x)), energy<double>(system, x) - potential,
                      1024.0 * std::abs(energy<double>(system, at_rest) - potential)});
  }
  while (run.step < steps) {
    fixed.advance(run, 1);
    const auto y = fixed.synchronous(run);
    if (!is_finite(y)) return run.step;
    if (!has_energy(system)) continue;
    const double before = energy<double>(system, x);
    if (!(std::abs(energy<double>(system, y) - before) <= 1e3 * scale)) return run.step;
  }
  return -1;
}

void gives_up_in_time(const model& system, const tabulated& method, double step, const state& x) {
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
  const auto refused = [&](const point& x, std::int64_t steps, std::int64_t every,
                           std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { integrate(system, verlet(), 0.1, x, steps, no_observer, every); }, words);
  };
  BOOST_TEST(refused(at(0, 0), -1, 1, {"integrate", "steps -1"}));
  BOOST_TEST(refused(at(0, 0), 10, 0, {"integrate", "every 0"}));
  BOOST_TEST(refused(at(0, 0), 10, -3, {"integrate", "every -3"}));
  BOOST_TEST(refused(at(not_a_number, 0), 10, 1, {"start", "finite", "dimension"}));
  BOOST_TEST(refuses<wrong>([&] { integrate(system, verlet(), 0.0, at(0, 0), 1); }, {"step", "not zero"}));
  for (const Eigen::Index of_p : {5, 6}) {
    const state misfit{Eigen::VectorXd::Zero(5), Eigen::VectorXd::Zero(of_p)};
    BOOST_TEST(refuses<wrong>([&] { integrate(chain, by_verlet, 0.1, misfit, 1); }, {"dimension"}));
  }
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
    if (n > 0) fixed.advance(run, n - run.step);
    BOOST_TEST(same_bits(x, n == 0 ? at(1, 0) : fixed.synchronous(run)));  // first the start itself
  };
  const auto end = integrate(system, verlet(), 0.1, at(1, 0), 200, observe, 75);
  BOOST_TEST((seen == std::vector<std::int64_t>{0, 75, 150}));
  BOOST_TEST(end.steps == 200);
  fixed.advance(run, 50);
  BOOST_TEST(same_bits(end.finish, fixed.synchronous(run)));
}

BOOST_AUTO_TEST_CASE(divergence_is_named_by_its_first_step_whoever_looks) {
  gives_up_in_time(oscillator, by_verlet, 2.001, one(1, 0));  // by its energy
  gives_up_in_time(chain, by_verlet, 0.05, {Eigen::VectorXd::Constant(6, 0.1), Eigen::VectorXd::Ones(6)});
  gives_up_in_time(runaway(), by_verlet, 0.1, one(1, 1));  // without an energy, by what is not finite
  BOOST_TEST(first_bad_step(oscillator, by_verlet, 1.99, one(1, 0), 5000) == -1);
  BOOST_TEST(!integrate(oscillator, by_verlet, 1.99, one(1, 0), 5000).diverged_at.has_value());
}

BOOST_AUTO_TEST_CASE(a_passing_excursion_is_judged_the_same_whoever_looks) {
  // Just inside Verlet's limit the energy swings by more than 1e3 and comes back.
  const auto unobserved = integrate(oscillator, by_verlet, 1.9991, one(0, 2), 10000);
  BOOST_TEST(first_bad_step(oscillator, by_verlet, 1.9991, one(0, 2), 10000) > 0);
  for (const std::int64_t every : {1, 50, 64, 100, 10000}) {
    const auto end = integrate(oscillator, by_verlet, 1.9991, one(0, 2), 10000, no_observer, every);
    BOOST_TEST((end.diverged_at == unobserved.diverged_at));
    BOOST_TEST(same_bits(end.finish, unobserved.finish));
  }
}

namespace {

/// A state of that energy, K = p^2/2 alone.
state with_energy(double energy) { return one(0.0, std::sqrt(2.0 * energy)); }
model in(const bath& heat_bath) { return in_bath(harmonic_oscillator(1.0), heat_bath); }

/// Whether the bound lies at 1e3 times the scale, to a part in a thousand.
bool has_scale(const model& system, double scale, double start = 0.0) {
  divergence diverged(system, with_energy(start));
  return !diverged(with_energy(start + 0.999e3 * scale)) && diverged(with_energy(start + 1.001e3 * scale));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_scale_of_divergence_is_the_energy_at_the_start_or_that_of_the_bath) {
  BOOST_TEST(has_scale(oscillator, 1.0, 1.0));
  BOOST_TEST(has_scale(oscillator, 1e-18, 1e-18));  // no energy is large or small by itself
  BOOST_TEST(has_scale(oscillator, 7.0, 7.0));
  BOOST_TEST(!has_scale(oscillator, 7.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 5.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 5.0)), 7.0, 7.0));
  BOOST_TEST(has_scale(in(bath::of_temperature(0.1, 0.2)), 0.2));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.5, 3.0)), 9.0));  // kT = sigma^2/(2 gamma)
  BOOST_TEST(!has_scale(in(bath::of_temperature(0.1, 5.0)), 1.0));
  BOOST_TEST(has_scale(in(bath::of_sigma(0.0, 0.0)), 7.0, 7.0));  // what does not act changes nothing
  BOOST_TEST(has_scale(in(bath::of_sigma(0.1, 0.0)), 7.0, 7.0));
  divergence at_rest(oscillator, with_energy(0.0));  // nothing has a scale: only what is not finite is lost
  BOOST_TEST(!at_rest(with_energy(1e100)));
  BOOST_TEST(at_rest.last_change() == 1e100, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(at_rest(one(std::nan(""), 1.0)));
  const model many = in_bath(dynamic_potential{.masses = 4}, bath::of_temperature(0.1, 5.0));
  const auto moving = [](double p) {
    return state{Eigen::VectorXd::Zero(4), Eigen::VectorXd::Constant(4, p)};
  };
  divergence diverged(many, moving(0.0));  // 4 p^2/2 against 1e3 4 kT
  BOOST_TEST(!diverged(moving(std::sqrt(0.999e3 * 10.0))));
  BOOST_TEST(diverged(moving(std::sqrt(1.001e3 * 10.0))));
}

BOOST_AUTO_TEST_CASE(each_lane_has_its_own_bound) {
  using T = pack<double, 2>;
  const auto both_at = [](double first, double second) {
    auto x = with_energy(first).cast<T>();
    set_lane(x, 1, with_energy(second));
    return x;
  };
  const model warm = in(bath::of_temperature(0.1, 5.0));
  divergence<model, T> diverged(warm, both_at(0.0, 7.0));
  const auto found = diverged(both_at(6000.0, 6000.0));
  BOOST_TEST(found[0]);
  BOOST_TEST(!found[1]);
}

// Noise without friction: the energy grows for ever, and rightly so. Only what is not finite is lost.
BOOST_AUTO_TEST_CASE(a_bath_that_heats_has_no_bound) {
  const model heated = in(bath::of_sigma(0.0, 1.0));
  divergence diverged(heated, with_energy(0.0));
  BOOST_TEST(!diverged(with_energy(1e100)));
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    BOOST_TEST(diverged(one(bad, 1.0)));
  }
}

BOOST_AUTO_TEST_CASE(any_system_goes_in_lanes) {
  draws random;
  for (const specimen& one : specimens_with([](const model& system) { return system.facts().in_lanes; })) {
    for (const auto& method : {by_verlet, tabulated(srkn6b())}) {
      const run_of run{one.system, method, 0.02};
      BOOST_TEST(run.lanes_are_alone(one, random), describe(one.system) << ", " << method.name());
    }
  }
  const auto& galaxy = specimen_of("henon_heiles");
  BOOST_TEST(!(run_of{galaxy.system, by_verlet, 0.02}).lanes_are_alone(galaxy, random, 32));  // a step apart
}

// Within Boost.Odeint's loops our methods give our states.
BOOST_AUTO_TEST_CASE(the_loops_of_odeint_see_our_states) {
  namespace odeint = boost::numeric::odeint;
  const henon_heiles galaxy;
  const auto start = draws().state(galaxy, 0.2);
  constexpr double h = 0.1;
  constexpr std::size_t steps = 100;
  using states = std::vector<phase_point<double, 2>>;
  const auto check = [&](const auto& method) {
    states ours;
    integrate(galaxy, method, h, start, steps,
              [&](std::int64_t, double, const auto& x) { ours.push_back(x); });
    // Each letter rounds twice in each of the steps; on a bounded regular orbit |J| grows with t, to some 2
    // t.
    const double rounding = steps * 4.0 * roundings(method, 2) * eps * 2.0 * h * steps;
    states theirs;
    double last_time = 0.0;
    const auto observe = [&](const phase_point<double, 2>& x, double t) {
      theirs.push_back(x);
      last_time = t;
    };
    const auto agrees = [&](const auto& x) {
      BOOST_REQUIRE(theirs.size() == ours.size());
      for (std::size_t n = 0; n < ours.size(); ++n) BOOST_TEST(distance(theirs[n], ours[n]) <= rounding);
      BOOST_TEST(same_bits(theirs.back(), x));
      BOOST_TEST(distance(x, ours.front()) > 1e-3);  // it moved
      theirs.clear();
    };
    auto x = start;
    odeint::integrate_const(odeint_stepper(method), galaxy, x, 0.0, h * steps, h, observe);
    BOOST_TEST(std::abs(last_time - 10.0) <= 10.0 * eps);  // the last point is there
    agrees(x);
    x = start;
    odeint::integrate_n_steps(odeint_stepper(method), galaxy, x, 0.0, h, steps, observe);
    agrees(x);
  };
  check(by_verlet);
  check(tabulated(takahashi_imada()));
  check(srkn6b());  // a method by its type
  BOOST_TEST(odeint_stepper<verlet>().order() == 2);
  BOOST_TEST(odeint_stepper<srkn11b>().order() == 6);
}
