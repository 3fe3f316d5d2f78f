// SPDX-License-Identifier: BSL-1.0
// The oracle of the other Langevin tests, checked by formulas that it does not use.
#include <boost/test/unit_test.hpp>

#include <complex>
#include <limits>

#include "../support/langevin_linear.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// Under-damped, nearly undamped, critical, over-damped.
const std::vector<damped_oscillator> oscillators{
    {3.0, 1.0, .7}, {3.0, .01, .7}, {50.0, .01, .05}, {3.0, 6.0, .7}, {3.0, 10.0, .7}};

/// e^{-gamma t/2} (cos w t + (A + gamma/2) sin(w t)/w) with w^2 = omega^2 - gamma^2/4.
square<2> closed_map(const damped_oscillator& x, double t) {
  const std::complex<double> w =
      std::sqrt(std::complex<double>(x.omega * x.omega - 0.25 * x.gamma * x.gamma));
  const double c = std::cos(w * t).real();
  const double s = w == 0.0 ? t : (std::sin(w * t) / w).real();
  square<2> map;
  map << c + 0.5 * x.gamma * s, s, -x.omega * x.omega * s, c - 0.5 * x.gamma * s;
  return std::exp(-0.5 * x.gamma * t) * map;
}

double difference(const auto& a, const auto& b) { return (a - b).cwiseAbs().maxCoeff(); }

const std::vector<spelled> baoab{{'B', .5}, {'A', .5}, {'O', 1.0}, {'A', .5}, {'B', .5}};

}  // namespace

BOOST_AUTO_TEST_CASE(the_solution_has_closed_form) {
  for (const auto& x : oscillators) {
    for (const double t : {1e-3, .3, 7.0}) {
      // The doublings multiply the rounding errors of the first piece, some 20 eps, by 4 |A| t at most.
      const double size = 1.0 + x.omega * x.omega + x.gamma;
      const double rounding = 20.0 * eps * size * (1.0 + 4.0 * size * t);
      const auto step = x.exact(t);
      const square<2> map = closed_map(x, t);
      const square<2> law = x.invariant();
      BOOST_TEST_CONTEXT("omega " << x.omega << ", gamma " << x.gamma << ", t " << t) {
        BOOST_TEST(difference(step.map, map) <= rounding);
        // The invariant law stays: C = Sigma - map Sigma map^T.
        const square<2> noise = law - map * law * map.transpose();
        BOOST_TEST(difference(step.covariance, noise) <= 2.0 * rounding * law.maxCoeff());
        // The Lyapunov equation divides by what a step forgets, 1 - det(map).
        const double forgotten = -std::expm1(-x.gamma * t);
        BOOST_TEST(difference(stationary(step), law) <= 4.0 * rounding / forgotten * law.maxCoeff());
        const double eta = x.exact_with_bath(t).covariance(2, 2);
        const double variance = -x.sigma * x.sigma * std::expm1(-2.0 * x.gamma * t) / (2.0 * x.gamma);
        BOOST_TEST(std::abs(eta - variance) <= rounding * variance);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(without_friction_the_noise_has_a_limit) {
  const damped_oscillator free{1e-9, 0.0, 2.0};  // Brownian motion and its integral
  const double t = 1.5;
  square<2> noise;
  noise << t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t;
  BOOST_TEST(difference(free.exact(t).covariance, 4.0 * noise) <= 100.0 * eps * 4.0);
}

BOOST_AUTO_TEST_CASE(many_fine_intervals_are_a_coarse_one) {
  for (const auto& x : oscillators) {
    const auto fine = x.exact_with_bath(1e-3);
    gaussian_step<3> composed;
    for (int n = 0; n < 100; ++n) composed = then(composed, fine);
    const auto coarse = x.exact_with_bath(0.1);
    const double rounding = 100.0 * 40.0 * eps * (1.0 + x.omega * x.omega);
    BOOST_TEST(difference(composed.map, coarse.map) <= rounding);
    BOOST_TEST(difference(composed.covariance, coarse.covariance) <= rounding * x.sigma * x.sigma);
    // Its factor gives it back, and an interval of another length is told apart.
    const square<3> L = cholesky(fine.covariance);
    BOOST_TEST(difference(L * L.transpose(), fine.covariance) <= 4.0 * eps * x.sigma * x.sigma);
    BOOST_TEST(difference(composed.covariance, x.exact_with_bath(0.101).covariance) >
               1e-4 * x.sigma * x.sigma);
  }
}

BOOST_AUTO_TEST_CASE(solution_and_error_are_those_of_the_parts) {
  for (const auto& x : oscillators) {
    const double h = 1.0 / x.omega;
    const auto both = step_with_error(x, baoab, h);
    const auto word = word_step(x, baoab, h);
    const auto exact = x.exact(h);
    Eigen::Matrix<double, 2, 4> sum;  // solution + error = word
    sum << 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
    const double rounding = 200.0 * eps * (1.0 + x.omega * x.omega);
    BOOST_TEST(difference(both.map.topLeftCorner(2, 2), exact.map) <= rounding);
    BOOST_TEST(difference(both.covariance.topLeftCorner(2, 2), exact.covariance) <= rounding);
    BOOST_TEST(difference(sum * both.map.leftCols(2), word.map) <= rounding);
    BOOST_TEST(difference(both.map.bottomRightCorner(2, 2), word.map) <= rounding);
    BOOST_TEST(difference(sum * both.covariance * sum.transpose(), word.covariance) <= rounding);
  }
}
