// SPDX-License-Identifier: BSL-1.0
// The covariance that a linear step keeps: against four linear equations.
#include "nysalt/losses/discrete_lyapunov.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/langevin_linear.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

square<2> as_matrix(const plane_map<double>& M) {
  square<2> result;
  result << M.xx, M.xy, M.yx, M.yy;
  return result;
}
square<2> as_matrix(const plane_covariance<double>& C) {
  square<2> result;
  result << C.xx, C.xy, C.xy, C.yy;
  return result;
}

/// A rotation by an angle between a shear and its inverse, times a factor.
plane_map<double> sheared_turn(double factor, double angle, double shear) {
  const plane_map<double> there{.xy = shear};
  const plane_map<double> back{.xy = -shear};
  const double c = factor * std::cos(angle);
  const double s = factor * std::sin(angle);
  return compose(compose(there, {c, s, -s, c}), back);
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_a_step_keeps_solves_the_linear_equations) {
  draws random;
  for (int n = 0; n < 200; ++n) {
    const plane_map<double> M{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                              random.uniform(-1, 1)};
    const plane_covariance<double> R{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (spectral_radius(as_matrix(M)) > 0.99) continue;
    const square<2> expected = stationary<2>({as_matrix(M), as_matrix(R)});
    const square<2> ours = as_matrix(discrete_lyapunov(M, R));
    // Some hundred operations on numbers below 16, over the denominator; of the oracle as many.
    const double d = M.determinant();
    const double t = M.trace();
    const double tolerance = 3200.0 * eps / ((1.0 - d) * (1.0 + d - t) * (1.0 + d + t));
    BOOST_TEST((ours - expected).cwiseAbs().maxCoeff() <= tolerance);
    // The equation of the transposed map is another one.
    const square<2> transposed = as_matrix(discrete_lyapunov({M.xx, M.yx, M.xy, M.yy}, R));
    BOOST_TEST((transposed - expected).cwiseAbs().maxCoeff() > tolerance);
  }
}

BOOST_AUTO_TEST_CASE(what_a_map_of_determinant_one_adds) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto S = sheared_turn(1.0, random.uniform(0, 3), random.uniform(-2, 2));
    const square<2> expected = as_matrix(S) * as_matrix(S).transpose() - square<2>::Identity();
    // Entries are below 6, their squares below 36: some ten roundings of each.
    BOOST_TEST((as_matrix(excess_of_turn(S)) - expected).cwiseAbs().maxCoeff() <= 360.0 * eps);
  }
  // Of a rotation the trace vanishes to twice as many digits; by products it does not.
  const auto turn = sheared_turn(1.0, 0.7, 1e-17);
  const auto excess = excess_of_turn(turn);
  BOOST_TEST(std::abs(excess.xx + excess.yy) <= eps * eps);
}

BOOST_AUTO_TEST_CASE(a_map_that_does_not_forget_keeps_nothing) {
  const plane_covariance<double> R{1.0, 0.5, 2.0};
  const auto has_covariance = [&](const plane_map<double>& M) {
    const auto D = discrete_lyapunov(M, R);
    BOOST_TEST(is_schur_stable(M) == std::isfinite(D.xx));
    BOOST_TEST(std::isfinite(D.xx) == std::isfinite(D.yy));
    return std::isfinite(D.xx);
  };
  for (const double angle : {0.0, 0.3, 1.6, 3.1}) {
    BOOST_TEST(has_covariance(sheared_turn(0.999, angle, 0.5)));
    BOOST_TEST(!has_covariance(sheared_turn(1.001, angle, 0.5)));
  }
  BOOST_TEST(!has_covariance({}));                      // the identity
  BOOST_TEST(!has_covariance({.xx = 1.5, .yy = 0.5}));  // d below 1
  BOOST_TEST(!has_covariance({.xx = -1.5, .yy = 0.5}));
  BOOST_TEST(!has_covariance({.xx = std::nan(""), .yy = 0.5}));
  BOOST_TEST(has_covariance({.xx = 0.9, .yy = -0.9}));
}
