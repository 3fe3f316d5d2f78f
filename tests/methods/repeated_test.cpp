// SPDX-License-Identifier: BSL-1.0
// A repeated method is its steps one after the other.
#include "nysalt/methods/repeated.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/classical_methods.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(a_repeated_method_is_its_steps_one_after_the_other) {
  draws random;
  const henon_heiles galaxy;
  constexpr double h = 0.3;
  for (const auto& method : nysalt::classical_methods()) {
    if (method.letters().letters().find('R') != std::string::npos) continue;
    for (const int times : {1, 2, 3}) {
      if (times > 1 && method.letters().is_processed()) continue;  // refused: see processed_test.cpp
      const auto whole = repeated(method, times);
      BOOST_TEST(whole.letters().evaluations_per_step == times * method.letters().evaluations_per_step);
      auto once = random.state(galaxy, 0.2);
      auto steps = once;
      make_stepper(galaxy, whole, h).step(once);
      const auto part = make_stepper(galaxy, method, h / times);
      for (int n = 0; n < times; ++n) part.step(steps);
      // Coefficients times h / n, or times h and then 1/n: two roundings for each of some 60 letters.
      BOOST_TEST((once.q - steps.q).norm() < 1e-14, method.name() << " " << times);
      BOOST_TEST((once.p - steps.p).norm() < 1e-14, method.name() << " " << times);
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_of_a_cost_take_as_many_evaluations) {
  for (const int evaluations : {1, 2, 3, 4, 5, 6}) {
    const auto all = classical_methods_of_cost(evaluations);
    BOOST_TEST(all.size() >= 3U);
    for (const auto& method : all) BOOST_TEST(method.letters().evaluations_per_step == evaluations);
  }
}

BOOST_AUTO_TEST_CASE(letters_of_a_bath_and_no_step_are_refused) {
  BOOST_TEST(refuses<std::invalid_argument>([] { repeated(tabulated(baoab{}), 2); }, {"BAOAB"}));
  BOOST_TEST(
      refuses<std::invalid_argument>([] { repeated(nysalt::classical_methods().front(), 0); }, {"0 steps"}));
}
