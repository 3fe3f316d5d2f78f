// SPDX-License-Identifier: BSL-1.0
// Means over time that do not depend on where samples lie.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/analysis/sample_weights.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The mean of t^k over samples of a step, by weights.
double mean_of_power(const sample_weights& weights, double step, std::int64_t samples, int k) {
  double sum = 0.0;
  for (std::int64_t i = 0; i <= samples; ++i) {
    sum += weights(i) * std::pow(static_cast<double>(i) * step, k);
  }
  return sum / weights.total();
}

}  // namespace

BOOST_AUTO_TEST_CASE(samples_alike_leave_out_the_start) {
  const sample_weights alike(4);
  BOOST_TEST(alike(0) == 0.0);
  for (std::int64_t i = 1; i <= 4; ++i) BOOST_TEST(alike(i) == 1.0);
  BOOST_TEST(alike.total() == 4.0);
}

// What is linear has its exact mean for any step; t^2 errs as the header says, by n^-2/2 at most.
BOOST_AUTO_TEST_CASE(means_up_to_a_horizon_are_those_of_what_lies_between) {
  for (const double step : {0.1, 0.083, 0.0999, 0.05, 0.011}) {
    const auto samples = static_cast<std::int64_t>(std::ceil(1.0 / step - 1e-9));
    const sample_weights weights(step, samples, 1.0);
    const auto near = boost::test_tools::tolerance(100 * eps);  // of that many terms at most
    BOOST_TEST(weights.total() == 1.0 / step, near);
    BOOST_TEST(mean_of_power(weights, step, samples, 0) == 1.0, near);
    BOOST_TEST(mean_of_power(weights, step, samples, 1) == 0.5, near);
    BOOST_TEST(std::abs(3.0 * mean_of_power(weights, step, samples, 2) - 1.0) <= 0.51 * step * step);
  }
}

// Ten samples alike of t^2 are 16 % above its mean, and the last of nine covers less.
BOOST_AUTO_TEST_CASE(samples_alike_depend_on_the_step) {
  BOOST_TEST(3.0 * mean_of_power(sample_weights(10), 0.1, 10, 2) > 1.15);
  BOOST_TEST(3.0 * mean_of_power(sample_weights(12), 0.08, 12, 2) < 1.07);
}

BOOST_AUTO_TEST_CASE(a_horizon_ends_within_the_last_step) {
  BOOST_CHECK_NO_THROW(sample_weights(0.1, 10, 0.901));
  BOOST_CHECK_NO_THROW(sample_weights(0.1, 3, 0.3));  // 0.30000000000000004/0.1
  BOOST_CHECK_NO_THROW(sample_weights(-0.1, 10, 1.0));
  for (const double horizon : {0.9, 1.1, 0.0, -1.0, std::nan("")}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { sample_weights(0.1, 10, horizon); },
                                              {"sample_weights: horizon must lie", "10 steps of 0.1"}));
  }
}
