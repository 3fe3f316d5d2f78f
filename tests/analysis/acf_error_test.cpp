// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/acf_error.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/autoregression.hpp"
#include "../support/refusal.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int lags = 10;

autocovariance of(double phi, std::uint64_t number, int groups = 32) {
  return autocovariance_of(phi, seed(number), groups, 200, lags);
}

double between_laws(double phi, double psi) {
  double sum = 0.0;
  for (int k = 1; k <= lags; ++k) sum += std::pow(std::pow(phi, k) - std::pow(psi, k), 2);
  return std::sqrt(sum / lags);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_distance_of_two_laws_is_found_within_its_error) {
  const auto found = acf_error(of(0.6, 1), of(0.7, 2));
  const double allowed = standard_errors(false_alarms, 62) * found.standard_error;  // 32 groups each
  BOOST_TEST(std::abs(found.rms - between_laws(0.6, 0.7)) < allowed);
  BOOST_TEST(std::abs(found.rms - between_laws(0.6, 0.8)) > allowed);
  BOOST_TEST(found.rms > 5.0 * found.floor);
}

// The mean of rms^2 is floor^2. Over 400 pairs its mean is known to 1/sqrt(400/2) = 7 % if all lags went
// together, and better as they do not. A floor by 7 + 7 degrees of freedom errs: its inverse square has the
// mean 14/12.
BOOST_AUTO_TEST_CASE(one_law_is_at_the_floor) {
  double squares = 0.0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const auto found = acf_error(of(0.6, 1000 + 2 * k, 8), of(0.6, 1001 + 2 * k, 8));
    squares += found.rms * found.rms / (found.floor * found.floor) / 400.0;
  }
  const double allowed = standard_errors(false_alarms) * 0.07 + 0.17;
  BOOST_TEST(std::abs(squares - 1.0) < allowed);
  BOOST_TEST(std::abs(squares / 4.0 - 1.0) > allowed);  // a floor twice as high would be seen
}

// The scatter of the error over 200 repetitions is known to 1/sqrt(400) = 5 %, each error to 1/sqrt(28) = 19
// %, and their mean to 1.3 %.
BOOST_AUTO_TEST_CASE(the_standard_error_is_that_of_repetitions) {
  std::vector<double> rms;
  double error = 0.0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto found = acf_error(of(0.5, 3000 + 2 * k, 8), of(0.7, 3001 + 2 * k, 8));
    rms.push_back(found.rms);
    error += found.standard_error / 200.0;
  }
  const double ratio = error / std::sqrt(covariance(rms, rms));
  const double allowed = standard_errors(false_alarms) * std::hypot(0.05, 0.013);
  BOOST_TEST(std::abs(ratio - 1.0) < allowed);
  BOOST_TEST(std::abs(2.0 * ratio - 1.0) > allowed);
}

BOOST_AUTO_TEST_CASE(what_does_not_compare_is_refused) {
  const auto a = of(0.6, 1, 2);
  const auto fewer = autocovariance_of(0.6, 1, 2, 200, 9);
  BOOST_TEST(refuses<std::invalid_argument>([&] { acf_error(a, fewer); }, {"10 lags", "9 lags"}));
  autocovariance_sums sums(lags + 1);
  sums[0].pairs = 1.0;
  const autocovariance slower(1.01, 0.0, {sums});
  BOOST_TEST(refuses<std::invalid_argument>([&] { acf_error(a, slower); }, {"1.01", "same times"}));
  BOOST_TEST(acf_error(a, a).rms == 0.0);
}
