// SPDX-License-Identifier: BSL-1.0
// The acceptance and the step on Gaussian targets, against their closed forms.
#include "nysalt/analysis/gaussian_acceptance.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The mean of min(1, exp(-x)) over x normal of mean mu and variance 2 mu, by the midpoint rule.
double accepted(double mu) {
  constexpr int points = 200'000;
  constexpr double reach = 8.0;  // deviations: beyond lies 1e-15
  const double deviation = std::sqrt(2.0 * mu);
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double u = reach * (2.0 * (k + 0.5) / points - 1.0);
    const double x = mu + deviation * u;
    sum += std::exp(-0.5 * u * u) * std::min(1.0, std::exp(-x));
  }
  return sum * 2.0 * reach / points / std::sqrt(2.0 * std::numbers::pi);
}

}  // namespace

// The midpoint rule errs by the jump of the slope at x = 0 times the square of its interval, 8e-5, over 24.
BOOST_AUTO_TEST_CASE(the_acceptance_is_the_mean_of_metropolis_rule) {
  for (const double mu : {1e-3, 0.0316, 0.5, 3.0}) {
    BOOST_TEST(std::abs(acceptance_at(mu) - accepted(mu)) <= 1e-9);
    BOOST_TEST(std::abs(acceptance_at(1.001 * mu) - accepted(mu)) > 1e-9);
    BOOST_TEST(energy_error_at(acceptance_at(mu)) == mu, boost::test_tools::tolerance(1e-11));
  }
  BOOST_TEST(acceptance_at(0.0) == 1.0);
  BOOST_TEST(acceptance_at(std::numeric_limits<double>::infinity()) == 0.0);
}

// d oscillators of one frequency and Verlet's method: d z^4/(64 (1 - z^2/4)) = mu is quadratic in z^2. The
// step is found to 1e-9.
BOOST_AUTO_TEST_CASE(the_step_of_verlet_is_the_closed_form) {
  const double mu = energy_error_at(0.9);
  for (const int d : {1, 100, 10'000}) {
    const std::vector<double> frequencies(static_cast<std::size_t>(d), 3.0);
    const double a = d / 64.0;
    const double b = mu / 4.0;
    const double closed = std::sqrt((-b + std::sqrt(b * b + 4.0 * a * mu)) / (2.0 * a)) / 3.0;
    const double found = gaussian_step(tabulated(verlet{}), frequencies, 0.9);
    BOOST_TEST(std::abs(found / closed - 1.0) <= 2e-9);
    BOOST_TEST(std::abs(gaussian_step(tabulated(verlet{}), frequencies, 0.89) / closed - 1.0) > 1e-3);
    BOOST_TEST(std::abs(gaussian_step(tabulated(verlet{}), frequencies, 0.9, 5.0 * closed) / closed - 1.0) <=
               2e-9);
    // Errors add up over oscillators.
    BOOST_TEST(gaussian_energy_error(tabulated(verlet{}), frequencies, found) == mu,
               boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  using wrong = std::invalid_argument;
  const std::vector<double> one{1.0};
  const std::vector<double> none{0.0};
  const std::vector<double> many(1'000'000'000 / 1'000'000, 1.0);
  const tabulated method{verlet{}};
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, none, 0.9); }, {"a frequency must be positive"}));
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, {}, 0.9); }, {"a frequency must be positive"}));
  for (const double acceptance : {0.0, 1.0, -1.0, std::nan("")}) {
    BOOST_TEST(refuses<wrong>([&] { gaussian_step(method, one, acceptance); }, {"between 0 and 1"}));
  }
  BOOST_TEST(
      refuses<wrong>([&] { gaussian_step(method, many, 1.0 - 1e-12); }, {"must be one that verlet reaches"}));
  BOOST_TEST(refuses<wrong>([&] { gaussian_step(tabulated(mclachlan_atela4{}), one, 0.9); },
                            {"must be reversible"}));
  BOOST_TEST(gaussian_energy_error(method, one, 2.5) == std::numeric_limits<double>::infinity());
}
