// SPDX-License-Identifier: BSL-1.0
// D is its formula, p += b h f(q + c h^2 M^-1 f(q)), keeps volume, runs back, and is not symplectic.
#include "nysalt/flows/displaced_kick.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/derivatives/reversibility.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/families/fd_chin.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double h = 0.4;
constexpr double b = 0.7;
constexpr double c = 0.13;

const henon_heiles galaxy;

}  // namespace

BOOST_AUTO_TEST_CASE(the_kick_is_that_of_the_formula) {
  draws random;
  const two_masses system;
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(system, 1.0);
    vector<double, 2> f;
    vector<double, 2> displaced;
    force<double>(system, x.q, f);
    const vector<double, 2> q(x.q[0] + c * h * h * f[0], x.q[1] + c * h * h * 0.25 * f[1]);  // masses 1, 4
    force<double>(system, q, displaced);
    const vector<double, 2> expected = x.p + b * h * displaced;
    const double rounding = 60.0 * eps;  // some 30 operations on numbers below 2, twice
    auto of_type = x;
    stepper<two_masses, word<displaced_kick>>(system, {b, c}, h).step(of_type);
    auto of_data = x;
    stepper(system, run_time_word("D"), {b, c}, h).step(of_data);
    BOOST_TEST((of_type.p - expected).norm() <= rounding);
    BOOST_TEST(same_bits(of_type, of_data));
    const vector<double, 2> without_masses = x.q + c * h * h * f;
    force<double>(system, without_masses, displaced);
    BOOST_TEST((x.p + b * h * displaced - expected).norm() > 1e4 * rounding);
  }
}

BOOST_AUTO_TEST_CASE(it_costs_two_evaluations_of_a_black_box_too) {
  const counted<black_box> system{black_box()};
  const auto evaluations = [&](const auto& method, int steps) {
    const auto stepper = make_stepper(system, method, 0.1);
    auto run = stepper.open(phase_point<double, 1>{vector<double, 1>(0.3), vector<double, 1>(0.2)});
    system.evaluations = 0;
    stepper.advance(run, steps);
    return system.evaluations;
  };
  BOOST_TEST(evaluations(chin4a_displaced{}, 10) == 30);
  BOOST_TEST(evaluations(chin4a{}, 10) == 40);  // differences take two
  BOOST_TEST(run_time_word("BADAB").evaluations_per_step == 3);
  BOOST_TEST(word<displaced_kick>::evaluations_of_plain_step == 2);
}

BOOST_AUTO_TEST_CASE(it_keeps_volume_and_runs_back_but_is_not_symplectic) {
  draws random;
  const fd_chin family;
  for (int n = 0; n < 5; ++n) {
    const auto x = random.state(galaxy, 0.3);
    const member<fd_chin> method({0.17, 0.05});
    // Below 100 operations on numbers of order one, a step of six letters of two coordinates.
    const double rounding = 100.0 * eps;
    BOOST_TEST(std::abs(jacobian(step_map(galaxy, method, h), x).determinant() - 1.0) <= rounding);
    BOOST_TEST(reversibility_defect(galaxy, method, h, x) <= rounding);
    BOOST_TEST(symplecticity_defect(galaxy, method, h, x) > 1e4 * rounding);
    const harmonic_oscillator spring(1.3);
    BOOST_TEST(symplecticity_defect(spring, method, h, random.state(spring, 1.0)) <= rounding);
  }
  BOOST_TEST(!word_of(family).is_symplectic);
  BOOST_TEST(!run_time_word("BADAB").is_symplectic);
  BOOST_TEST(run_time_word("BAGAB").is_symplectic);
}

// To leading order D(b, c) is G(b, b c/2): one is the other with the force's Taylor polynomial.
BOOST_AUTO_TEST_CASE(its_order_is_that_of_the_gradient_kick_up_to_four) {
  BOOST_TEST((taylor_order(chin4a_displaced{}) == taylor_order(chin4a{})));
  BOOST_TEST(taylor_order(chin4a_displaced{}).quadratic_kinetic == 4);
  BOOST_TEST(taylor_order(run_time_word("BADAB"), {1.0 / 6.0, 0.5, 2.0 / 3.0, 0.04, 0.5, 1.0 / 6.0})
                 .quadratic_kinetic == 2);
}
