// SPDX-License-Identifier: BSL-1.0
// Drifts carry the time: driven motion has its order, is symplectic and reversible, and is learned.
#include "nysalt/systems/in_time.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../support/rounding.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const in_time<driven_pendulum> pendulum_in_time(driven_pendulum(0.4, 1.7));
const auto start = pendulum_in_time.state({vector<double, 1>(0.5), vector<double, 1>(-0.2)}, 0.3);

template <class M>
phase_point<double, 2> after(const M& method, double step, int steps) {
  return integrate(pendulum_in_time, method, step, start, steps).finish;
}

/// q'' = -q + cos(w t) from rest at q = 0 at the time 0: (cos w t - cos t)/(1 - w^2).
struct driven_oscillator {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q, const T& t) const {
    using std::cos;
    return q[0] * q[0] * 0.5 - q[0] * cos(t * 0.6);
  }
};
/// Unequal masses, each of which counts.
struct driven_pair {
  static constexpr int dimension = 2;
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  template <class T>
  T potential(const vector<T, 2>& q, const T& t) const {
    return (q[0] - q[1]) * (q[0] - q[1]) * 0.5 + q[0] * t;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(time_goes_as_it_does) {
  const auto end = after(verlet(), 0.125, 80);  // sums of eighths are exact
  BOOST_TEST(pendulum_in_time.time(start) == 0.3);
  BOOST_TEST(std::abs(pendulum_in_time.time(end) - 10.3) <= 80.0 * 10.0 * eps);
  BOOST_TEST(pendulum_in_time.at_its_time(start).q[0] == 0.5);
  BOOST_TEST(pendulum_in_time.at_its_time(start).p[0] == -0.2);
}

// S6 at a step of .01 errs by some 1e-13, and rounding of 1000 steps by as much.
BOOST_AUTO_TEST_CASE(a_driven_oscillator_goes_where_it_must) {
  const in_time<driven_oscillator> system;
  const auto from = system.state({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.0);
  const auto end = integrate(system, blanes_moan_s6(), 0.01, from, 1000).finish;
  const double exact = (std::cos(6.0) - std::cos(10.0)) / (1.0 - 0.36);
  BOOST_TEST(std::abs(end.q[0] - exact) <= 1e-11);
  BOOST_TEST(std::abs(end.q[0] - (std::cos(6.06) - std::cos(10.0)) / 0.64) > 1e-3);
}

BOOST_AUTO_TEST_CASE(masses_count) {
  const in_time<driven_pair> system;
  const auto x = system.state({{0.1, 0.2}, {1.0, 2.0}}, 0.5);
  vector<double, 3> v;
  system.velocity(x.p, v);
  BOOST_TEST(v[0] == 1.0);
  BOOST_TEST(v[1] == 0.5);
  BOOST_TEST(v[2] == 1.0);
  BOOST_TEST(std::abs(energy<double>(system, x)) <= 4.0 * eps);
  BOOST_TEST(check_force(system, {x.q}, {x.p}).passed());
}

BOOST_AUTO_TEST_CASE(words_have_their_orders) {
  const auto exact = after(blanes_moan_s6(), 0.005, 1000);
  const auto order = [&](const auto& method, double step, int steps) {
    return std::log2(distance(after(method, step, steps), exact) /
                     distance(after(method, step / 2, 2 * steps), exact));
  };
  // The next even power of the step changes the ratio by less than a tenth of an order here.
  BOOST_TEST(std::abs(order(verlet(), 0.05, 100) - 2.0) < 0.1);
  BOOST_TEST(std::abs(order(forest_ruth(), 0.05, 100) - 4.0) < 0.2);
}

// Four products a sum, of entries of order one, each off by some hundred roundings.
BOOST_AUTO_TEST_CASE(steps_are_symplectic_and_go_back) {
  BOOST_TEST(symplecticity_defect(pendulum_in_time, pefrl(), 0.2, start) <= 4.0 * 100.0 * eps);
  auto x = start;
  make_stepper(pendulum_in_time, pefrl(), 0.2).step(x);
  BOOST_TEST(distance(x, start) > 0.01);
  make_stepper(pendulum_in_time, pefrl(), -0.2).step(x);
  BOOST_TEST(distance(x, start) <= 100.0 * eps);
}

// H changes, as work is done, and H + p_t hardly does.
BOOST_AUTO_TEST_CASE(the_energy_with_that_of_the_drive_stays) {
  const auto end = after(verlet(), 0.01, 1000);
  BOOST_TEST(std::abs(energy<double>(pendulum_in_time, end)) < 1e-4);
  BOOST_TEST(std::abs(end.p[1] - start.p[1]) > 0.01);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  BOOST_CHECK_THROW(driven_pendulum(std::numeric_limits<double>::quiet_NaN(), 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(pendulum_in_time.state({vector<double, 1>(0.0), vector<double, 1>(0.0)},
                                           std::numeric_limits<double>::infinity()),
                    std::invalid_argument);
  static_assert(!NystromSystem<in_time<driven_pendulum>> && SeparableSystem<in_time<driven_pendulum>>);
}

BOOST_AUTO_TEST_CASE(a_method_is_learned) {
  std::vector<phase_point<double, 2>> states;
  for (int k = 0; k < 32; ++k) {
    states.push_back(pendulum_in_time.state(
        {vector<double, 1>(0.05 * k - 0.8), vector<double, 1>(0.3 - 0.02 * k)}, 0.37 * k));
  }
  const auto data = [&](std::ptrdiff_t from) {
    const listed<2> starts({states.begin() + from, states.begin() + from + 16});
    return make_flow_map_data(pendulum_in_time, starts, fine_steps(0.01, blanes_moan_s6()),
                              {.step = 0.5, .horizon = 5.0, .trajectories = 16, .seed = 1});
  };
  const auto found = learn(aba<3>(), pendulum_in_time, data(0), data(16), {.random_starts = 4});
  BOOST_TEST(found.summary.usable, found.summary.reason);
  BOOST_TEST(found.summary.held_out_loss < 0.6 * found.summary.held_out_start_loss);
}
