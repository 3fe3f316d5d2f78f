// SPDX-License-Identifier: BSL-1.0
// A table that others measured: the largest energy error of Principia's symplectic integrators on a harmonic
// oscillator, from its own tests (github.com/mockingbirdnest/Principia). Its convention: mass and stiffness
// 1, q = 1 and p = 0 at the start, step .2, 500 units of time, |H - H_0| absolute. H_0 is 1/2, so that is
// half of our relative error. Its leapfrog begins with a drift: with a kick the error would be h^2/8
// = 5.00e-3 instead of h^2/8/(1 - h^2/4) = 5.05e-3.
#include <boost/test/unit_test.hpp>

#include "nysalt/analysis/energy_drift.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;

namespace {

double largest_energy_error(const auto& method) {
  const harmonic_oscillator system(1.0);
  const phase_point<double, 1> start{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  const auto record = energy_drift(system, method, .2, start, 2500);
  BOOST_TEST(!record.diverged_at.has_value());
  BOOST_TEST_MESSAGE(method.name() << ": " << 0.5 * record.largest);
  return 0.5 * record.largest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(energy_errors_are_those_of_others) {
  const auto two_percent = boost::test_tools::tolerance(.02);  // the table gives two or three digits
  BOOST_TEST(largest_energy_error(verlet_aba()) == 5.05e-3, two_percent);
  BOOST_TEST(largest_energy_error(mclachlan2()) == 4.48e-5, two_percent);
  BOOST_TEST(largest_energy_error(bcss2()) > 2.0 * 4.48e-5);  // the same word with another coefficient
  BOOST_TEST(largest_energy_error(forest_ruth()) == 6.27e-5, two_percent);
  BOOST_TEST(largest_energy_error(mclachlan_atela4()) == 7.52e-7, two_percent);
  BOOST_TEST(largest_energy_error(mclachlan5()) == 7.83e-7, two_percent);
  BOOST_TEST(largest_energy_error(blanes_moan_s6()) == 2.24e-7, two_percent);
  BOOST_TEST(largest_energy_error(srkn6b()) == 1.56e-9, two_percent);
  BOOST_TEST(largest_energy_error(srkn11b()) == 9.1e-12, two_percent);
  BOOST_TEST(largest_energy_error(srkn14a()) == 6.3e-13, two_percent);
}
