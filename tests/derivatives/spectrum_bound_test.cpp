// SPDX-License-Identifier: BSL-1.0
// The ends of a spectrum are bounds: a Ritz value lies inside the spectrum, and is moved outwards by its
// residual.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/draws.hpp"
#include "nysalt/derivatives/lanczos.hpp"

using namespace nysalt;
using namespace nysalt::test;

// Some eigenvalue lies within the residual, at most 0.01, of a Ritz value. That is the end itself where all
// others are 0.1 away.
BOOST_AUTO_TEST_CASE(isolated_ends_are_not_passed_inwards) {
  constexpr Eigen::Index n = 200;
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(n, -0.9, 0.9);
  values[0] = -1.0;
  values[n - 1] = 1.0;
  const auto multiply = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return values.cwiseProduct(v); };
  draws random;
  for (int trial = 0; trial < 10; ++trial) {
    Eigen::VectorXd start(n);
    for (double& x : start) x = random.uniform(-1.0, 1.0);
    const auto ends = ends_of_spectrum(multiply, start);
    BOOST_TEST(ends.highest >= 1.0);
    BOOST_TEST(ends.lowest <= -1.0);
    // By Rayleigh quotients of the Ritz vectors: the values themselves are inside.
    BOOST_TEST(ends.highest_direction.dot(multiply(ends.highest_direction)) < 1.0);
    BOOST_TEST(ends.lowest_direction.dot(multiply(ends.lowest_direction)) > -1.0);
  }
}
