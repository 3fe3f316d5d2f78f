// SPDX-License-Identifier: BSL-1.0
// The accuracy of single runs: the energy error of a symplectic method is bounded and has no trend, and that
// of any other grows; errors at a horizon fall with the step by the order of the method.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "../support/allocations.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/convergence_order.hpp"
#include "nysalt/analysis/energy_drift.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The galaxy with a force that is a gradient, or is not, as a torque turns it.
struct galaxy_with_torque : henon_heiles {
  double torque = 0.0;
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    henon_heiles::force(q, f);
    f[0] = f[0] - q[1] * torque;
    f[1] += q[0] * torque;
  }
};
const galaxy_with_torque galaxy;
const galaxy_with_torque twisted{{}, 1e-3};
const phase_point<double, 2> star{{0.1, 0.2}, {0.25, -0.1}};

phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

const model swing{pendulum()};
const phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd::Constant(1, 1.0),
                                                Eigen::VectorXd::Constant(1, 0.5)};

fine_steps<tabulated> fine(double step, const tabulated& method = tabulated(srkn11b())) {
  return fine_steps<tabulated>(step, method);
}

order_measurement measure(const tabulated& method, const fine_steps<tabulated>& reference,
                          std::int64_t fewest, int halvings) {
  return convergence_order(swing, method, reference, start, 4.0, fewest, halvings);
}

const tabulated by_verlet{verlet()};
/// A mistake in Verlet: the kick is a little too weak, which is not even consistent.
const tabulated weak_kick("weak_kick", run_time_word("BAB"), {0.499, 1.0, 0.499}, {2, true, false});

}  // namespace

BOOST_AUTO_TEST_CASE(symplectic_means_bounded_and_without_a_trend) {
  constexpr double step = 0.1;
  const auto shorter = energy_drift(galaxy, verlet(), step, star, 5'000);
  const auto longer = energy_drift(galaxy, verlet(), step, star, 50'000);
  BOOST_TEST(!longer.diverged_at.has_value());
  BOOST_TEST(shorter.largest > 0.0);
  BOOST_TEST(longer.largest < 2.0 * shorter.largest);  // ten times as long, and the same bound
  // A bounded oscillation of amplitude A over N >> 1 cycles has a slope of at most A/(N cycles) per cycle:
  // over the whole time T less than A.
  BOOST_TEST(std::abs(longer.drift) * 5'000.0 < longer.largest);
  const auto drifting = energy_drift(twisted, verlet(), step, star, 5'000);
  BOOST_TEST(std::abs(drifting.drift) * 500.0 > 0.5 * drifting.largest);
  BOOST_TEST(drifting.largest > 5.0 * shorter.largest);
}

// On the oscillator Verlet conserves p^2 + w^2 (1 - z^2/4) q^2, so that |H - H_0| is z^2/8 w^2 q^2 at most.
BOOST_AUTO_TEST_CASE(the_largest_error_is_known_on_the_oscillator) {
  const harmonic_oscillator system(2.0);
  const auto result = energy_drift(system, verlet(), 0.1, at(1.0, 0.0), 100'000);
  BOOST_TEST(result.largest <= 0.04 / 4.0 * (1.0 + 1e-9));
  BOOST_TEST(result.largest == 0.04 / 4.0,
             boost::test_tools::tolerance(1e-4));  // some step is near the extremum
}

BOOST_AUTO_TEST_CASE(a_divergence_is_told) {
  const harmonic_oscillator system(2.0);
  BOOST_TEST(energy_drift(system, verlet(), 1.01, at(1.0, 0.0), 10'000).diverged_at.has_value());
  BOOST_TEST(!energy_drift(system, verlet(), 0.99, at(1.0, 0.0), 10'000).diverged_at.has_value());
}

BOOST_AUTO_TEST_CASE(looking_seldom_sees_less) {
  const auto often = energy_drift(galaxy, verlet(), 0.1, star, 1000);
  const auto seldom = energy_drift(galaxy, verlet(), 0.1, star, 1000, 50);
  BOOST_TEST(seldom.largest <= often.largest);
  BOOST_TEST(seldom.largest > 0.0);
}

// At the bottom of the well H_0 is 0, and errors are absolute.
BOOST_AUTO_TEST_CASE(without_energy_errors_are_absolute) {
  const harmonic_oscillator system(2.0);
  const auto result = energy_drift(system, verlet(), 0.1, at(0.0, 0.0), 100);
  BOOST_TEST(result.largest == 0.0);
  BOOST_TEST(result.drift == 0.0);
}

BOOST_AUTO_TEST_CASE(the_drift_is_the_slope_of_least_squares) {
  const auto compare = [](const auto& system, std::int64_t steps, std::int64_t every) {
    std::vector<double> times;
    std::vector<double> errors;
    const double initial = energy<double>(system, star);
    const auto keep = [&](std::int64_t, double t, const auto& x) {
      times.push_back(t);
      errors.push_back((energy<double>(system, x) - initial) / std::abs(initial));
    };
    integrate(system, verlet(), 0.1, star, steps, keep, every);
    const auto record = energy_drift(system, verlet(), 0.1, star, steps, every);
    // Each of n sums rounds once: n eps of the largest error, over a time T.
    const auto n = static_cast<double>(times.size());
    BOOST_TEST(std::abs(record.drift - slope(times, errors)) <=
               8.0 * n * eps * record.largest / times.back());
    BOOST_TEST(record.drift != 0.0);
  };
  compare(galaxy, 20'000, 1);
  compare(galaxy, 20'000, 7);
  compare(twisted, 5'000, 1);
  compare(twisted, 1, 1);
  BOOST_TEST(energy_drift(galaxy, verlet(), 0.1, star, 5, 10).drift == 0.0);  // one sample has no trend
}

BOOST_AUTO_TEST_CASE(long_runs_need_no_more_memory) {
  const std::size_t before = allocations;
  const auto record = energy_drift(galaxy, verlet(), 0.1, star, 10'000);
  BOOST_TEST(allocations - before == 0U);
  BOOST_TEST(record.largest > 0.0);
  std::vector<double> something(8);
  asm volatile("" : : "r"(something.data()) : "memory");  // clang leaves out what has no effect
  BOOST_TEST(allocations - before > 0U);                  // the count would see it
}

// The steps are so small that the next even power of them adds less than a tenth to the error of the first:
// log2(1.1) < .15.
BOOST_AUTO_TEST_CASE(orders_are_those_of_the_methods) {
  BOOST_TEST(std::abs(measure(by_verlet, fine(1e-2), 16, 5).order - 2.0) < 0.15);
  BOOST_TEST(std::abs(measure(tabulated(pefrl()), fine(1e-2), 16, 4).order - 4.0) < 0.15);
  BOOST_TEST(std::abs(measure(tabulated(blanes_moan_s6()), fine(1e-2), 8, 4).order - 4.0) < 0.15);
  BOOST_TEST(std::abs(measure(tabulated(srkn11b()), fine(2.5e-3), 8, 3).order - 6.0) < 0.15);
  BOOST_TEST(measure(weak_kick, fine(1e-2), 16, 5).order < 1.0);
}

BOOST_AUTO_TEST_CASE(steps_are_halved_and_errors_measured_at_the_horizon) {
  const auto result = measure(by_verlet, fine(1e-2), 16, 3);
  BOOST_TEST(result.steps == (std::vector<double>{0.25, 0.125, 0.0625, 0.03125}),
             boost::test_tools::per_element());
  BOOST_REQUIRE(result.errors.size() == 4);
  auto exact = start;
  fine(1e-2).advance(swing, exact, 4.0);
  const auto end = integrate(swing, by_verlet, 0.0625, start, 64).finish;
  BOOST_TEST(result.errors[2] == distance(end, exact), boost::test_tools::tolerance(1e-12));
}

// Where a method is as good as the reference, what is left is no order.
BOOST_AUTO_TEST_CASE(noise_is_no_order) {
  BOOST_TEST(std::isnan(measure(by_verlet, fine(0.125, by_verlet), 32, 4).order));
  BOOST_TEST(std::isnan(measure(tabulated(srkn11b()), fine(1e-3), 4000, 3).order));  // rounding alone
  BOOST_TEST(std::isnan(measure(by_verlet, fine(1e-2), 16, 0).order));               // a single step
}

// Steps in the noise do not count, but those above it do.
BOOST_AUTO_TEST_CASE(the_order_is_taken_above_the_noise) {
  const auto result = measure(tabulated(srkn6b()), fine(1e-2), 32, 10);
  BOOST_TEST(result.errors.back() < 1e-11);
  BOOST_TEST(std::abs(result.order - 4.0) < 0.15);
}

// Large steps run away; the order is that of those which do not.
BOOST_AUTO_TEST_CASE(what_diverged_has_no_error_and_no_part_in_the_order) {
  const phase_point<double, Eigen::Dynamic> x{Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.25, -0.1)};
  const model stars{henon_heiles()};
  const auto result = convergence_order(stars, by_verlet, fine(1e-2), x, 40.0, 10, 9);
  BOOST_REQUIRE(result.errors.size() == 10);
  BOOST_REQUIRE(result.steps.size() == 10);
  BOOST_REQUIRE(integrate(stars, by_verlet, 4.0, x, 10).diverged_at.has_value());
  BOOST_TEST(result.errors[0] == std::numeric_limits<double>::infinity());
  BOOST_TEST(result.errors[9] < 1e-3);
  // Of the eight steps that remain only the two largest are off their power, by less than a third.
  BOOST_TEST(std::abs(result.order - 2.0) < 0.15);
}

BOOST_AUTO_TEST_CASE(steps_and_halvings_that_cannot_be_are_refused) {
  using wrong = std::invalid_argument;
  BOOST_TEST(refuses<wrong>([&] { measure(by_verlet, fine(1e-2), 0, 3); }, {"convergence_order", "got 0,"}));
  BOOST_TEST(
      refuses<wrong>([&] { measure(by_verlet, fine(1e-2), -4, 3); }, {"convergence_order", "got -4,"}));
  BOOST_TEST(
      refuses<wrong>([&] { measure(by_verlet, fine(1e-2), 16, -1); }, {"convergence_order", ", -1 and"}));
  for (const double horizon : {0.0, std::nan("")}) {
    BOOST_TEST(refuses<wrong>([&] { convergence_order(swing, by_verlet, fine(1e-2), start, horizon, 4, 2); },
                              {"convergence_order", "horizon"}));
  }
}
