// SPDX-License-Identifier: BSL-1.0
// Autocovariances of processes that are known, and whether the error bars are right.
#include "nysalt/analysis/autocovariance.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include "../support/autoregression.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int groups = 256;
constexpr int samples = 300;
constexpr int lags = 20;
constexpr double n = 8.0 * groups * samples;

const autocovariance& measured() {
  static const autocovariance result = autocovariance_of(0.7, seed(11), groups, samples, lags);
  return result;
}

/// The largest |rho - phi^k| in standard errors.
double off(const autocovariance& of, double phi) {
  const auto rho = of.normalised();
  const auto error = of.standard_error();
  double worst = 0.0;
  for (std::size_t k = 1; k < rho.size(); ++k) {
    worst = std::max(worst, std::abs(rho[k] - std::pow(phi, k)) / error[k]);
  }
  return worst;
}

/// Bartlett's formula for the variance of rho(k) from n samples, for phi^k.
double bartlett(double phi, double k) {
  const double square = phi * phi;
  const double at_lag = std::pow(square, k);
  return ((1.0 + square) * (1.0 - at_lag) / (1.0 - square) - 2.0 * k * at_lag) / n;
}

/// sqrt(2) cos(omega t + phase) for that many phases all around: means over them are cos(omega k) and 0.
autocovariance of_phases(double omega, int phases) {
  std::vector<autocovariance_sums> sums;
  for (int m = 0; m < phases; ++m) {
    autocovariance_along<double> along(lags, 5.0);
    for (int t = 0; t < 100; ++t) {
      along.add(5.0 + std::numbers::sqrt2 * std::cos(omega * t + 2.0 * std::numbers::pi * m / phases));
    }
    sums.push_back(along.in_lane(0));
  }
  return autocovariance(0.1, 5.0, sums);
}

}  // namespace

// 20 lags, the variance and the mean; .72 is off by .02 at lag 1, where the error is .001.
BOOST_AUTO_TEST_CASE(an_autoregression_forgets_as_it_should) {
  constexpr double each = false_alarms / (lags + 2);
  BOOST_TEST(off(measured(), 0.7) < standard_errors(each, groups - 1));
  BOOST_TEST(off(measured(), 0.72) > standard_errors(each, groups - 1));
  const double allowed = standard_errors(each);
  BOOST_TEST(measured().normalised()[0] == 1.0);
  // Variance 1, with 1/n (1 + phi^2)/(1 - phi^2) times 2 as the variance of it; the mean as an integrated
  // time.
  BOOST_TEST(std::abs(measured().covariance(0) - 1.0) < allowed * std::sqrt(2.0 / n * 1.49 / 0.51));
  BOOST_TEST(std::abs(measured().mean()) < allowed * std::sqrt(1.0 / n * 1.7 / 0.3));
}

// 256 groups tell an error to 1/sqrt(510) = 4.4 %, lags after 300 samples change Bartlett's by less than 7 %.
BOOST_AUTO_TEST_CASE(errors_are_those_of_theory) {
  const double allowed = standard_errors(false_alarms / lags) * 0.044 + 0.07;
  const auto error = measured().standard_error();
  BOOST_TEST(error[0] == 0.0);
  for (std::size_t k = 1; k < error.size(); ++k) {
    const double ratio = error[k] / std::sqrt(bartlett(0.7, static_cast<double>(k)));
    BOOST_TEST(std::abs(ratio - 1.0) < allowed);
    BOOST_TEST(std::abs(2.0 * ratio - 1.0) > allowed);
  }
}

// To rounding: 5 + cos has roundings of 5 eps, and the sums add their square root of 100.
BOOST_AUTO_TEST_CASE(oscillators_of_all_phases_have_a_cosine) {
  const auto cosine = of_phases(0.3, 7);
  const auto rho = cosine.normalised();
  for (std::size_t k = 0; k < rho.size(); ++k) {
    BOOST_TEST(std::abs(rho[k] - std::cos(0.3 * static_cast<double>(k))) < 100.0 * eps);
  }
  BOOST_TEST(std::abs(cosine.covariance(0) - 1.0) < 100.0 * eps);
  BOOST_TEST(std::abs(cosine.mean() - 5.0) < 100.0 * eps);
  BOOST_TEST(std::abs(of_phases(0.3, 2).normalised()[4] - std::cos(1.2)) > 1e-6);  // two phases are not all
}

BOOST_AUTO_TEST_CASE(groups_without_a_trajectory_do_not_count) {
  autocovariance_sums one(2);
  one[0] = {3.0, 6.0, 1.0, 1.0};
  one[1] = {2.0, 2.0, 1.0, 0.0};
  const autocovariance alone(1.0, 0.0, {one});
  const autocovariance among_none(1.0, 0.0, {autocovariance_sums(2), one, autocovariance_sums(2)});
  BOOST_TEST(among_none.groups() == 1U);
  BOOST_TEST(among_none.covariance(1) == alone.covariance(1));
  BOOST_TEST(std::isnan(among_none.standard_error()[1]));
  const autocovariance twice(1.0, 0.0, {one, one});
  BOOST_TEST(twice.standard_error()[1] < 10.0 * eps);  // groups that agree have no spread
}

BOOST_AUTO_TEST_CASE(what_has_no_autocovariance_is_refused) {
  const autocovariance none(1.0, 0.0, {autocovariance_sums(3)});
  BOOST_TEST(std::isnan(none.mean()));
  BOOST_TEST(refuses<std::runtime_error>([&] { none.normalised(); }, {"no trajectory counts"}));
  autocovariance_along<double> constant(2, 4.0);
  for (int t = 0; t < 9; ++t) constant.add(4.0);
  const autocovariance frozen(1.0, 4.0, {constant.in_lane(0)});
  BOOST_TEST(refuses<std::runtime_error>([&] { frozen.normalised(); }, {"does not vary"}));
  BOOST_TEST(refuses<std::invalid_argument>([] { autocovariance(1.0, 0.0, {}); },
                                            {"groups of trajectories must be one or more"}));
  BOOST_TEST(refuses<std::invalid_argument>(
      [] {
        autocovariance(1.0, 0.0, {autocovariance_sums(3), autocovariance_sums(5)});
      },
      {"got 2 and 4"}));
}
