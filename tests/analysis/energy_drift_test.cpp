// SPDX-License-Identifier: BSL-1.0
// The energy error of a symplectic method is bounded and has no trend; that of any other grows.
#include <boost/test/unit_test.hpp>

#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "../support/allocations.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/energy_drift.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The galaxy with a force that is not a gradient: one per mille of a torque turns it.
struct twisted_galaxy : henon_heiles {
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    henon_heiles::force(q, f);
    f[0] = f[0] - q[1] * 1e-3;
    f[1] += q[0] * 1e-3;
  }
};
const phase_point<double, 2> start{{0.1, 0.2}, {0.25, -0.1}};

phase_point<double, 1> at(double q, double p) { return {vector<double, 1>(q), vector<double, 1>(p)}; }

}  // namespace

BOOST_AUTO_TEST_CASE(symplectic_means_bounded_and_without_a_trend) {
  const henon_heiles galaxy;
  constexpr double step = 0.1;
  const auto shorter = energy_drift(galaxy, verlet(), step, start, 5'000);
  const auto longer = energy_drift(galaxy, verlet(), step, start, 50'000);
  BOOST_TEST(!longer.diverged_at.has_value());
  BOOST_TEST(shorter.largest > 0.0);
  BOOST_TEST(longer.largest < 2.0 * shorter.largest);  // ten times as long, and the same bound
  // A bounded oscillation of amplitude A over N >> 1 cycles has a slope of at most A/(N cycles) per cycle:
  // over the whole time T less than A.
  BOOST_TEST(std::abs(longer.drift) * 5'000.0 < longer.largest);
  const twisted_galaxy twisted;
  const auto drifting = energy_drift(twisted, verlet(), step, start, 5'000);
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
  const henon_heiles galaxy;
  const auto often = energy_drift(galaxy, verlet(), 0.1, start, 1000);
  const auto seldom = energy_drift(galaxy, verlet(), 0.1, start, 1000, 50);
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
  const henon_heiles galaxy;
  const twisted_galaxy twisted;
  const auto compare = [](const auto& system, std::int64_t steps, std::int64_t every) {
    std::vector<double> times;
    std::vector<double> errors;
    const double initial = energy<double>(system, start);
    const auto keep = [&](std::int64_t, double t, const auto& x) {
      times.push_back(t);
      errors.push_back((energy<double>(system, x) - initial) / std::abs(initial));
    };
    integrate(system, verlet(), 0.1, start, steps, keep, every);
    const auto record = energy_drift(system, verlet(), 0.1, start, steps, every);
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
  BOOST_TEST(energy_drift(galaxy, verlet(), 0.1, start, 5, 10).drift == 0.0);  // one sample has no trend
}

BOOST_AUTO_TEST_CASE(long_runs_need_no_more_memory) {
  const henon_heiles galaxy;
  const std::size_t before = allocations;
  const auto record = energy_drift(galaxy, verlet(), 0.1, start, 10'000);
  BOOST_TEST(allocations - before == 0U);
  BOOST_TEST(record.largest > 0.0);
  std::vector<double> something(8);
  asm volatile("" : : "r"(something.data()) : "memory");  // clang leaves out what has no effect
  BOOST_TEST(allocations - before > 0U);                  // the count would see it
}
