// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/kinetic_temperature.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const linear_chain masses(Eigen::MatrixXd{{3.0, -1.0}, {-1.0, 2.0}}, Eigen::VectorXd{{1.0, 4.0}});

}  // namespace

BOOST_AUTO_TEST_CASE(masses_count) {
  phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd{{0.5, -1.0}}, Eigen::VectorXd{{3.0, 2.0}}};
  // (9/1 + 4/4)/2; the force is -(3 q0 - q1, -q0 + 2 q1) = (-2.5, 2.5), and half a step of .4 gives
  // (2.5, 2.5): (6.25 + 6.25/4)/2.
  BOOST_TEST(kinetic_temperature<double>(masses, x) == 5.0, boost::test_tools::tolerance(10 * eps));
  BOOST_TEST(half_step_kinetic_temperature<double>(masses, 0.4, x) == 3.90625,
             boost::test_tools::tolerance(10 * eps));
}

// p dK/dp for K = sqrt(1 + p^2): equipartition, not 2 K.
BOOST_AUTO_TEST_CASE(any_kinetic_energy_has_a_temperature) {
  draws random;
  const relativistic system;
  const auto x = random.state(system, 2.0);
  double sum = 0.0;
  for (const double p : x.p) sum += p * p / std::sqrt(1.0 + p * p);
  BOOST_TEST(kinetic_temperature<double>(system, x) == sum / static_cast<double>(x.size()),
             boost::test_tools::tolerance(20 * eps));
}

BOOST_AUTO_TEST_CASE(lanes_do_not_change_a_bit) {
  using T = pack<double, 8>;
  draws random;
  std::vector<phase_point<double, Eigen::Dynamic>> states;
  for (int k = 0; k < 8; ++k) states.push_back(random.state(masses, 1.0));
  const auto all = gather<T, Eigen::Dynamic>(8, [&](int k) { return states[static_cast<std::size_t>(k)]; });
  const T temperature = kinetic_temperature<T>(masses, all);
  const T half_step = half_step_kinetic_temperature<T>(masses, 0.3, all);
  for (int k = 0; k < 8; ++k) {
    const auto& alone = states[static_cast<std::size_t>(k)];
    BOOST_TEST(temperature[k] == kinetic_temperature<double>(masses, alone));
    BOOST_TEST(half_step[k] == half_step_kinetic_temperature<double>(masses, 0.3, alone));
    BOOST_TEST(half_step[k] != half_step_kinetic_temperature<double>(masses, 0.31, alone));
  }
}

// Verlet takes q = A cos(n turn + phase) to momenta of the amplitude omega A cos(turn/2) at the steps: over
// all phases <p^2> = (1 - z^2/4) omega^2 <q^2>. Half a kick later they have omega^2 <q^2>, which is kT.
BOOST_AUTO_TEST_CASE(half_steps_of_an_oscillator_show_its_temperature) {
  const harmonic_oscillator oscillator(2.0);
  const double step = 0.6;
  const double z = 1.2;
  const double turn = 2.0 * std::asin(0.5 * z);  // a step, as cos(turn) = 1 - z^2/2
  double on_step = 0.0;
  double half_step = 0.0;
  constexpr int phases = 16;
  for (int k = 0; k < phases; ++k) {
    const double phase = 2.0 * std::acos(-1.0) * k / phases;
    phase_point<double, 1> x;
    x.q[0] = std::sqrt(2.0) / 2.0 * std::cos(phase);  // <omega^2 q^2> = 1
    x.p[0] = -std::sqrt(2.0) * std::cos(0.5 * turn) * std::sin(phase);
    on_step += kinetic_temperature<double>(oscillator, x) / phases;
    half_step += half_step_kinetic_temperature<double>(oscillator, step, x) / phases;
  }
  BOOST_TEST(half_step == 1.0, boost::test_tools::tolerance(20 * eps));
  BOOST_TEST(on_step == 1.0 - z * z / 4.0, boost::test_tools::tolerance(20 * eps));
}
