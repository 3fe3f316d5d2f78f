// SPDX-License-Identifier: BSL-1.0
// Magnification is the largest norm of the powers of a step's matrix.
#include <boost/test/unit_test.hpp>

#include <numbers>

#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/transient_growth.hpp"
#include "nysalt/detail/step_on_oscillator.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const run_time_word impulse("RSR");
const std::vector<double> halves{0.5, 1.0, 0.5};

double by_powers(const run_time_word& word, const std::vector<double>& c, double theta, double k, int steps) {
  const auto times_k = [k](double x) { return k * x; };
  Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  step_on_oscillator(word, c, theta, times_k, one(0, 0), one(1, 0));
  step_on_oscillator(word, c, theta, times_k, one(0, 1), one(1, 1));
  const double omega = std::sqrt(theta * theta + k);
  one(0, 1) *= omega;
  one(1, 0) /= omega;
  Eigen::Matrix2d power = one;
  double largest = 1.0;
  for (int n = 1; n <= steps; ++n) {
    largest = std::max(largest, spectral_norm(power));
    power = one * power;
  }
  return largest;
}

}  // namespace

// The formula lets n t come to pi/2, which some n of 200 do to within a few degrees.
BOOST_AUTO_TEST_CASE(it_is_that_of_all_powers) {
  draws random;
  int unstable = 0;
  for (int n = 0; n < 300; ++n) {
    const double theta = n % 5 == 0 ? 0.0 : random.uniform(0.1, 7.0);
    const double k = random.uniform(0.01, 4.0);
    const double expected = by_powers(impulse, halves, theta, k, 200);
    const double found = transient_growth(impulse, halves, theta, k, 200);
    if (expected > 1e6) ++unstable;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", theta " << theta << ", k " << k) {
      if (expected < 1e6) BOOST_TEST(std::abs(found - expected) <= 0.05 * expected);
      if (expected >= 1e6) BOOST_TEST(found > 1e5);
    }
  }
  BOOST_TEST(unstable > 10);
}

// S R S at h omega = pi is -(1, 0; k, 1) in (q, p): g = n k/omega beside the diagonal after n steps, with
// omega^2 = pi^2 + k, and the norm g/2 + sqrt(1 + g^2/4).
BOOST_AUTO_TEST_CASE(impulses_grow_linearly_at_a_resonance) {
  const double pi = std::numbers::pi;
  const double k = 0.09;
  const double per_step = k / std::sqrt(pi * pi + k);
  for (const std::int64_t steps : {1000, 10'000}) {
    const double found = transient_growth(run_time_word("SRS"), {0.5, 1.0, 0.5}, pi, k, steps);
    const double g = per_step * static_cast<double>(steps);
    // Rounding of pi makes t some 2e-9, and the error (n t)^2.
    BOOST_TEST(std::abs(found / (0.5 * g + std::sqrt(1.0 + 0.25 * g * g)) - 1.0) < 1e-8);
  }
  BOOST_TEST(transient_growth(impulse, halves, 0.9 * pi, k, 10'000) < 1.1);
}

BOOST_AUTO_TEST_CASE(what_is_exact_magnifies_nothing) {
  BOOST_TEST(transient_growth(run_time_word("R"), {1.0}, 2.0, 1e-30, 10'000) <= 1.0 + 1e-9);
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_not_within_a_bound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(!(transient_growth(impulse, {0.5, nan, 0.5}, 2.0, 0.1, 100) <= 1e300));
}
