// SPDX-License-Identifier: BSL-1.0
// Symplecticity is seen on every system where it is, and missed where it is not.
#include <boost/test/unit_test.hpp>

#include "../laws/method_laws.hpp"
#include "../laws/models.hpp"
#include "../support/tableau.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(members_of_a_family_are_symplectic_on_every_system, Model, systems) {
  draws random;
  const auto system = Model::make();
  for (int n = 0; n < 20; ++n) {
    const auto method = any_method<member<nystrom>>(random);
    const auto [b1, beta1] = method.parameters();
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << b1 << ", beta1 = " << beta1) {
      BOOST_TEST(symplecticity_broken(system, method, random.state(system, Model::reach)) <= 1.0);
    }
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(explicit_euler_is_not, Model, systems) {
  draws random;
  const auto system = Model::make();
  const auto x = random.state(system, Model::reach);
  const auto at = shears_at(system, x);
  const double h = gentle_step(at);
  const auto euler = [&](auto& y) {
    auto f = y.q;
    auto v = y.q;
    using T = typename std::decay_t<decltype(y)>::scalar_type;
    force<T>(system, y.q, f);
    velocity<T>(system, y.p, v);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      y.q[i] += v[i] * h;
      y.p[i] += f[i] * h;
    }
  };
  BOOST_TEST(symplecticity_defect(euler, x) > 1e6 * jacobian_rounding(system, verlet(), h, at));
}

// The paper's condition on a21 is what makes the tableau symplectic.
BOOST_AUTO_TEST_CASE(a_nystrom_tableau_with_another_a21_is_not) {
  draws random;
  const auto system = a_galaxy::make();
  const auto x = random.state(system, a_galaxy::reach);
  const auto at = shears_at(system, x);
  const double h = gentle_step(at);
  const member<nystrom> method({0.4, 0.3});
  auto coefficients = tableau::symplectic(0.4, 0.3);
  const auto step = [&](auto& y) { coefficients.step(system, y, h); };
  BOOST_TEST(symplecticity_defect(step, x) <= jacobian_rounding(system, method, h, at));
  coefficients.a21 *= 1.01;
  BOOST_TEST(symplecticity_defect(step, x) > 1e6 * jacobian_rounding(system, method, h, at));
}

// A black box without a derivative is differentiated by differences: no more can be had than eps^(2/3).
BOOST_AUTO_TEST_CASE(a_black_box_shows_it_up_to_its_differences) {
  draws random;
  const black_box system;
  const double h = 0.25;
  for (int n = 0; n < 20; ++n) {
    const auto x = random.state(system, 1.0);
    const auto method = any_method<member<nystrom>>(random);
    // Two derivatives with an error of 2 eps^(2/3) each, times h c, and J is below 2.
    BOOST_TEST(symplecticity_defect(system, method, h, x) <= 8.0 * std::pow(eps, 2.0 / 3.0));
  }
}
