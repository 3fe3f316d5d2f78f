// SPDX-License-Identifier: BSL-1.0
// Methods that are declared symmetric are reversible, and a step back undoes a step forth.
#include <boost/test/unit_test.hpp>

#include <array>
#include <string>

#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(reversible_where_declared_symmetric_and_else_not, M, methods) {
  try_on_all<M>([](const auto& system, const auto& method, const auto& x) {
    const double reversible = reversibility_broken(system, method, x);
    const double undone = undoing_broken(system, method, x);
    if constexpr (M::symmetric) {
      BOOST_TEST(reversible <= 1.0);
      BOOST_TEST(undone <= 1.0);
    } else {
      BOOST_TEST(reversible > 10.0);
      BOOST_TEST(undone > 10.0);
    }
  });
}

BOOST_AUTO_TEST_CASE(members_with_equal_kicks_are_reversible) {
  draws random;
  const pendulum system;
  for (int n = 0; n < 20; ++n) {
    const double beta1 = random.uniform(0.0, 0.5);
    const auto x = random.state(system, 1.0);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", beta1 = " << beta1) {
      BOOST_TEST(reversibility_broken(system, member<nystrom>({0.5, beta1}), x) <= 1.0);
      BOOST_TEST(reversibility_broken(system, member<nystrom>({0.51, beta1}), x) > 10.0);
    }
  }
}

// Consistency: the coefficients of each letter sum to 1. Declared symmetric: they read the same backwards.
BOOST_AUTO_TEST_CASE_TEMPLATE(coefficients_are_consistent, M, methods) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto method = any_method<M>(random);
    const auto c = method.coefficients();
    const std::string letters = M::word::letters();
    for (const char letter : {'A', 'B', 'O'}) {
      double sum = 0.0;
      double size = 1.0;
      for (std::size_t i = 0; i < c.size(); ++i) {
        if (letters[i] != letter) continue;
        sum += c[i];
        size += std::abs(c[i]);
      }
      const bool is_used = letter != 'O' || M::word::stochastic_letters > 0;
      // Each coefficient and each sum rounds once.
      BOOST_TEST(std::abs(sum - (is_used ? 1.0 : 0.0)) <= static_cast<double>(c.size()) * eps * size);
    }
    for (std::size_t i = 0; M::symmetric && i < c.size(); ++i) BOOST_TEST(c[i] == c[c.size() - 1 - i]);
  }
}
