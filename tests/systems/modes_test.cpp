// SPDX-License-Identifier: BSL-1.0
// Modes diagonalise the quadratic part, and frequencies lie in the bands.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <numbers>

#include "../laws/models.hpp"
#include "../laws/system_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(modes_diagonalise_the_quadratic_part, Model, systems) {
  const auto system = Model::make();
  if constexpr (HasModes<system_of<Model>>) {
    BOOST_TEST(modes_defect(system, system.modes()) <= 1.0);
    auto wrong = system.modes();
    wrong.frequencies.tail(1) *= 1.0 + 1e-6;
    BOOST_TEST(modes_defect(system, wrong) > 10.0);
    wrong = system.modes();
    wrong.basis(0, 0) *= 1.0 + 1e-6;
    BOOST_TEST(modes_defect(system, wrong) > 10.0);
  }
}

using linear_systems = std::tuple<an_oscillator, a_chain, a_free_chain>;

BOOST_AUTO_TEST_CASE_TEMPLATE(linear_systems_have_their_frequencies_in_the_bands, Model, linear_systems) {
  const auto system = Model::make();
  draws random;
  const auto q = random.state(system, 1.0).q;
  BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  const double highest = system.frequency_bands().back().high;
  BOOST_TEST(band_defect(system, {{0.0, highest * (1.0 - 1e-6)}}, q) > 10.0);
}

// Stated for soft bonds that hold up to 2 each, however far the stiff ones are stretched.
BOOST_AUTO_TEST_CASE(the_bands_of_the_fpu_chain_hold_while_soft_bonds_are_not_overloaded) {
  const fpu_chain<3> system(10.0);
  const double longest = std::pow(2.0, 0.25);
  draws random;
  int tried = 0;
  double outside = 0.0;
  double outside_half = 0.0;
  while (tried < 200) {
    const auto q = random.state(system, 3.0 * longest).q;
    const std::array bonds{q[0], q[2] - q[1], q[4] - q[3], q[5]};
    if (std::any_of(bonds.begin(), bonds.end(), [&](double u) { return std::abs(u) > longest; })) continue;
    ++tried;
    outside = std::max(outside, band_defect(system, system.frequency_bands(), q));
    outside_half = std::max(outside_half, band_defect(system, system.frequency_bands(0.5), q));
  }
  BOOST_TEST(outside <= 1.0);
  BOOST_TEST(outside_half > 10.0);  // bands for a quarter of the energy do not hold
}

BOOST_AUTO_TEST_CASE(the_bands_of_the_pendulum_hold_while_it_hangs) {
  const pendulum system;
  draws random;
  for (int n = 0; n < 50; ++n) {
    const vector<double, 1> q(random.uniform(-std::numbers::pi, std::numbers::pi));
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, {{0.0, 0.5}}, vector<double, 1>(0.1)) > 10.0);
}

BOOST_AUTO_TEST_CASE(the_bands_of_henon_and_heiles_hold_on_bounded_orbits) {
  const henon_heiles system;
  draws random;
  for (int n = 0; n < 50; ++n) {
    const double r = random.uniform(0.0, 1.0);
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const vector<double, 2> q(r * std::cos(angle), r * std::sin(angle));
    BOOST_TEST(band_defect(system, system.frequency_bands(), q) <= 1.0);
  }
  BOOST_TEST(band_defect(system, system.frequency_bands(), vector<double, 2>(1.1, 0.0)) > 10.0);
}
