// SPDX-License-Identifier: BSL-1.0
// Frequencies of the linearised motion are those of K''(p) V''(q), whatever K is.
#include "nysalt/derivatives/frequencies_at.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(all_frequencies_of_a_state_are_those_of_the_hessian) {
  draws random;
  const dynamic_potential ring{5};
  for (int n = 0; n < 10; ++n) {
    const auto state = random.state(ring, 0.8);
    const Eigen::MatrixXd a = hessian(ring, state.q);
    const Eigen::VectorXd expected = symmetric_eigen(a).values;
    const auto found = frequencies_at(ring, state);
    BOOST_REQUIRE(found.size() == 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      const double square = expected[static_cast<Eigen::Index>(k)];
      // Squares of order ten that are known to rounding.
      BOOST_TEST(std::abs(found[k] * found[k] - std::max(0.0, square)) < 1e-12);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_kinetic_energy_of_any_kind_counts) {
  for (const double p : {0.0, 0.5, 2.0}) {
    for (const double q : {0.0, 0.3, 1.0}) {
      const auto found =
          frequencies_at(fast_particle{}, phase_point<double, 1>{vector<double, 1>(q), vector<double, 1>(p)});
      const double expected = std::sqrt((100.0 + 240.0 * q * q) * std::pow(1.0 + p * p, -1.5));
      BOOST_TEST(std::abs(found[0] / expected - 1.0) < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(of_large_systems_the_highest_alone_is_known) {
  draws random;
  const dynamic_potential large{most_for_all_frequencies + 1};
  const std::vector states{random.state(large, 0.5), random.state(large, 0.5)};
  const auto found = frequencies_of_states(large, states);
  BOOST_TEST(!found.are_complete);
  BOOST_REQUIRE(found.of_state.size() == 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    const Eigen::MatrixXd a = hessian(large, states[n].q);
    const double highest = std::sqrt(symmetric_eigen(a).values.maxCoeff());
    BOOST_TEST(std::abs(found.of_state[n][0] / highest - 1.0) < 0.01);
  }
  BOOST_TEST(found.highest().frequency == std::max(found.of_state[0][0], found.of_state[1][0]));
}
