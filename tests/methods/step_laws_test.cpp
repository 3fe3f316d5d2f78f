// SPDX-License-Identifier: BSL-1.0
// What one step of every method keeps, on every system: symplecticity, reversibility, consistency.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>

#include "../laws/laws.hpp"
#include "nysalt/families/nystrom.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

std::vector<specimen> differentiable_specimens() { return specimens_with(has_exact_derivatives); }

/// Sum of the first coefficients of letters of these kinds.
double sum_of(const tabulated& method, const std::string& kinds) {
  const auto& word = method.letters();
  const auto c = method.coefficients();
  double sum = 0.0;
  for (std::size_t i = 0; i < word.length; ++i) {
    if (kinds.find(word.letters()[i]) != std::string::npos) sum += c[word.first_slot(i)];
  }
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_CASE(steps_are_symplectic) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const tabulated& method, double step, const any_state& x) {
                    if (method.letters().is_symplectic) {
                      BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
                    } else {
                      BOOST_TEST(volume_broken(system, method, step, x) <= 1.0);
                    }
                  });
}

BOOST_AUTO_TEST_CASE(explicit_euler_is_not_and_a_displaced_kick_is_not) {
  draws random;
  for (const auto& one : differentiable_specimens()) {
    const auto x = one.at_random(random);
    const double step = 0.25 / shears_at(one.system, x).frequency();
    BOOST_TEST_CONTEXT(describe(one.system)) {
      BOOST_TEST(symplecticity_broken_by_euler(one.system, step, x) > 1e6);
    }
  }
  const auto& galaxy = specimen_of("henon_heiles");
  const tabulated displaced("displaced", run_time_word("BADAB"), {0.2, 0.5, 0.6, 0.05, 0.5, 0.2},
                            {2, true, true});
  const auto x = galaxy.at_random(random);
  BOOST_TEST(!displaced.letters().is_symplectic);
  BOOST_TEST(symplecticity_broken(galaxy.system, displaced, 0.2, x) > 1e3);
  BOOST_TEST(volume_broken(galaxy.system, displaced, 0.2, x) <= 1.0);
}

// J^T Omega J is e^{-gamma h} Omega for the friction gamma.
BOOST_AUTO_TEST_CASE(in_a_bath_steps_are_conformally_symplectic) {
  draws random;
  std::vector<specimen> exact;
  for (const auto& one : specimens_in_baths()) {
    if (has_exact_derivatives(one.system)) exact.push_back(one);
  }
  try_all(exact, methods_for_baths(random),
          [](const model& system, const tabulated& method, double step, const any_state& x) {
            BOOST_TEST(symplecticity_broken(system, method, step, x) <= 1.0);
            const model other = system.in(bath::of_sigma(system.bath().friction() + 1e-3, 0.1));
            BOOST_TEST(std::abs(other.bath().decay(step) - system.bath().decay(step)) > 1e-6);
          });
}

BOOST_AUTO_TEST_CASE(reversible_where_declared_symmetric_and_else_not) {
  try_all_methods(differentiable_specimens(), 2,
                  [](const model& system, const tabulated& method, double step, const any_state& x) {
                    const double reversible = reversibility_broken(system, method, step, x);
                    const double undone = undoing_broken(system, method, step, x);
                    if (method.symmetric) {
                      BOOST_TEST(reversible <= 1.0);
                      BOOST_TEST(undone <= 1.0);
                    } else if (!describe(system).starts_with("lennard_jones")) {  // atoms hardly move
                      BOOST_TEST(reversible > 1.0);
                      BOOST_TEST(undone > 1.0);
                    }
                  });
}

BOOST_AUTO_TEST_CASE(members_with_equal_kicks_are_reversible) {
  draws random;
  const auto& one = specimen_of("pendulum");
  for (int n = 0; n < 20; ++n) {
    const double beta1 = random.uniform(0.0, 0.5);
    const auto x = one.at_random(random);
    const auto broken = [&](double b1) {
      return reversibility_broken(one.system, tabulated(member<nystrom>({b1, beta1})), 0.25, x);
    };
    BOOST_TEST_CONTEXT("beta1 = " << beta1) {
      BOOST_TEST(broken(0.5) <= 1.0);
      BOOST_TEST(broken(0.51) > 10.0);
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
      double size = 1.0;
      for (const double x : c) size += std::abs(x);
      BOOST_TEST_CONTEXT(method.name() << ", draw " << n) {
        for (const char* kinds : {"AR", "BDGSH"}) {  // each coefficient and each sum rounds once
          BOOST_TEST(std::abs(sum_of(method, kinds) - 1.0) <= static_cast<double>(c.size()) * eps * size);
        }
        BOOST_TEST(sum_of(method, "O") == (word.stochastic_letters > 0 ? 1.0 : 0.0));
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
