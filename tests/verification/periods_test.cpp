// SPDX-License-Identifier: BSL-1.0
// Motions whose periods are known in closed form come back, by fine steps.
#include <boost/test/unit_test.hpp>

#include <numbers>

#include "../support/rounding.hpp"
#include "nysalt/ensembles/kepler_law.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

template <System S>
double missed_after(const S& system, const phase_point<double, S::dimension>& x, double time, double steps) {
  auto y = x;
  fine_steps<>(time / steps).advance(system, y, time);
  return distance(x, y);
}

/// 11 kicks and 12 drifts a step round every coordinate twice.
double rounding(double steps) { return steps * 46.0 * eps; }

}  // namespace

// Kepler's third law: 2 pi for a semi-major axis of 1, whatever the eccentricity.
BOOST_AUTO_TEST_CASE(a_planet_comes_back_after_its_year) {
  for (const double e : {0.0, 0.6}) {
    const auto x = kepler_law(e)(1, 2);
    constexpr double steps = 7000.0;  // the fastest motion has z = sqrt(2/(1 - e)^3) h = 5e-3
    // An error d of the energy moves the year by 3 pi d, and the speed is 2 at most.
    BOOST_TEST(missed_after(kepler(), x, two_pi, steps) <= 2.0 * 3.0 * std::numbers::pi * rounding(steps));
    BOOST_TEST(missed_after(kepler(), x, two_pi * (1.0 + 1e-6), steps) > 1e-7);
  }
}

// One mode alone, so small that the wells are not felt: cubes of 1e-6 are 1e-18.
BOOST_AUTO_TEST_CASE(a_wave_of_phi4_comes_back_after_its_period) {
  const phi4_chain<16> chain;
  const auto modes = chain.modes();
  for (Eigen::Index k = 1; k < 16; ++k) {
    const phase_point<double, 16> x{modes.basis.col(k) * 1e-6, vector<double, 16>::Zero()};
    const double period = two_pi / modes.frequencies[k];
    constexpr double steps = 1000.0;
    const double wells = 1e-18 * period * period;
    BOOST_TEST(missed_after(chain, x, period, steps) <= 1e-6 * rounding(steps) + wells);
    BOOST_TEST(missed_after(chain, x, 1.01 * period, steps) > 1e-9);
  }
}

// Two atoms near their rest: the reduced mass is 1/2 and V'' = 72/2^{1/3} at r = 2^{1/6}.
BOOST_AUTO_TEST_CASE(two_atoms_come_back_after_their_period) {
  const lennard_jones<2, 2> pair;
  const double apart = std::pow(2.0, 1.0 / 6.0);
  const double period = two_pi / std::sqrt(2.0 * 72.0 / std::cbrt(2.0));
  const double amplitude = 1e-4;
  const phase_point<double, 4> x{vector<double, 4>(0.0, 0.0, apart + amplitude, 0.0),
                                 vector<double, 4>::Zero()};
  constexpr double steps = 2000.0;
  // The anharmonic period is longer by some (amplitude V'''/V'')^2 of itself, V'''/V'' = 21/r.
  const double late = std::pow(21.0 / apart * amplitude, 2) * two_pi;
  const double speed = amplitude * two_pi / period;
  BOOST_TEST(missed_after(pair, x, period, steps) <= speed * late + rounding(steps));
  BOOST_TEST(missed_after(pair, x, 1.01 * period, steps) > 1e-6);
}
