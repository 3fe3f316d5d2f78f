// SPDX-License-Identifier: BSL-1.0
// The symplecticity defect of a step that is a function, and of a black box. tests/methods/step_laws_test.cpp
// has all methods.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "../support/tableau.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

// The paper's condition on a21 is what makes the tableau symplectic: 1 % of a21 changes q by 0.01 a21 h^2 =
// 1e-4 of f(q).
BOOST_AUTO_TEST_CASE(a_nystrom_tableau_with_another_a21_is_not_symplectic) {
  draws random;
  const henon_heiles system;
  const auto x = random.state(system, 0.25);
  auto coefficients = tableau::symplectic(0.4, 0.3);
  const auto step = [&](auto& y) { coefficients.step(system, y, 0.3); };
  BOOST_TEST(symplecticity_defect(step, x) <= 100.0 * eps);  // some hundred operations of numbers below 2
  coefficients.a21 *= 1.01;
  BOOST_TEST(symplecticity_defect(step, x) > 1e-6);
}

// A black box without a derivative is differentiated by differences: no more can be had than eps^(2/3).
BOOST_AUTO_TEST_CASE(a_black_box_shows_it_up_to_its_differences) {
  draws random;
  const black_box system;
  for (int n = 0; n < 20; ++n) {
    const member<nystrom> method({random.uniform(0.2, 0.8), random.uniform(0.1, 0.4)});
    // Two derivatives with an error of 2 eps^(2/3) each, times h c, and J is below 2.
    BOOST_TEST(symplecticity_defect(system, method, 0.25, random.state(system, 1.0)) <=
               8.0 * std::pow(eps, 2.0 / 3.0));
  }
}
