// SPDX-License-Identifier: BSL-1.0
// The force of every system is minus the gradient of its potential.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/system_laws.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(force_is_minus_the_gradient_of_the_potential, Model, systems) {
  const auto system = Model::make();
  if constexpr (HasEnergy<system_of<Model>>) {
    draws random;
    for (int n = 0; n < 20; ++n) {
      const auto x = random.state(system, Model::reach);
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n) {
        BOOST_TEST(gradient_defect(system, x.q) <= 1.0);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_force_too_strong_by_one_percent_is_found) {
  draws random;
  const wrong_force system;
  BOOST_TEST(gradient_defect(system, random.state(system, 1.0).q) > 1e6);
}

// The derivative of a black box is compared with that of the pendulum, which it hides.
BOOST_AUTO_TEST_CASE(a_black_box_has_derivatives_too) {
  draws random;
  const pendulum open;
  const auto visible = [](const vector<double, 1>& q) { return hessian(pendulum(), q)(0, 0); };
  for (int n = 0; n < 20; ++n) {
    const auto q = random.state(open, 3.0).q;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n) {
      BOOST_TEST(std::abs(hessian(black_box_with_derivative(), q)(0, 0) - visible(q)) <= 2.0 * eps);
      // Central differences along a displacement of 1: |f'''| s^2 / 6 + |f| eps / s.
      const double s = detail::part_of_displacement;
      const double error = std::abs(hessian(black_box(), q)(0, 0) - visible(q));
      BOOST_TEST(error <= s * s / 6.0 + 4.0 * eps * std::max(1.0, std::abs(q[0])) / s);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_source_of_derivatives_is_said) {
  BOOST_TEST(derivative_source<pendulum>() == "automatic differentiation");
  BOOST_TEST(derivative_source<black_box>() == "central differences of the force");
  BOOST_TEST(derivative_source<black_box_with_derivative>() == "the system's directional derivative");
}

BOOST_AUTO_TEST_CASE(velocity_is_the_gradient_of_the_kinetic_energy) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto p = random.state(relativistic(), 3.0).p;
    vector<double, 1> by_autodiff;
    vector<double, 1> own;
    velocity<double>(relativistic(), p, by_autodiff);
    velocity<double>(relativistic_with_velocity(), p, own);
    BOOST_TEST(std::abs(by_autodiff[0] - own[0]) <= 4.0 * eps);  // |v| < 1, four operations
  }
  const auto x = random.state(two_masses(), 1.0);
  vector<double, 2> v;
  velocity<double>(two_masses(), x.p, v);
  BOOST_TEST(v[0] == x.p[0]);
  BOOST_TEST(v[1] == 0.25 * x.p[1]);
}
