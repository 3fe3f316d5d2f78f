// SPDX-License-Identifier: BSL-1.0
// Methods that are declared symmetric are reversible, and a step back undoes a step forth.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../laws/trials.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE_TEMPLATE(reversible_where_declared_symmetric_and_else_not, Model, various_systems) {
  try_all_methods<Model>([](const auto& system, const auto& method, const auto& x) {
    const double reversible = reversibility_broken(system, method, x);
    const double undone = undoing_broken(system, method, x);
    if (method.symmetric) {
      BOOST_TEST(reversible <= 1.0);
      BOOST_TEST(undone <= 1.0);
    } else {
      BOOST_TEST(reversible > 1.0);  // of atoms that hardly move by little
      BOOST_TEST(undone > 1.0);
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

// Consistency: kicks of every kind sum to 1, and so do drifts and rotations. Declared symmetric: the word and
// its coefficients read the same backwards, letter by letter.
BOOST_AUTO_TEST_CASE(coefficients_are_consistent) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    for (const auto& method : methods_as_data(random)) {
      const auto& word = method.letters();
      const auto c = method.coefficients();
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << ", draw " << n) {
        for (const std::string kind : {"AR", "BDGSH", "O"}) {
          double sum = 0.0;
          double size = 1.0;
          for (std::size_t i = 0; i < word.length; ++i) {
            if (kind.find(word.letters()[i]) == std::string::npos) continue;
            sum += c[word.first_slot(i)];
            size += std::abs(c[word.first_slot(i)]);
          }
          const bool is_used = kind != "O" || word.stochastic_letters > 0;
          // Each coefficient and each sum rounds once.
          BOOST_TEST(std::abs(sum - (is_used ? 1.0 : 0.0)) <= static_cast<double>(c.size()) * eps * size);
        }
        for (std::size_t i = 0; method.symmetric && i < word.length; ++i) {
          const std::size_t other = word.length - 1 - i;
          BOOST_TEST(word.letters()[i] == word.letters()[other]);
          for (std::size_t k = 0; k < word.slots_of(i); ++k) {
            BOOST_TEST(c[word.first_slot(i) + k] == c[word.first_slot(other) + k]);
          }
        }
      }
    }
  }
}
