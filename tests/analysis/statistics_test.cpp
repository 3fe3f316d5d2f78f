// SPDX-License-Identifier: BSL-1.0
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/statistics.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using numbers = std::vector<double>;
}  // namespace

BOOST_AUTO_TEST_CASE(a_mean_comes_with_its_error) {
  const auto [mean, error] = mean_and_error(numbers{1.0, 2.0, 3.0, 6.0});
  BOOST_TEST(mean == 3.0, boost::test_tools::tolerance(8 * eps));
  BOOST_TEST(error == std::sqrt(14.0 / 3.0 / 4.0), boost::test_tools::tolerance(8 * eps));
}

BOOST_AUTO_TEST_CASE(too_few_samples_give_no_number) {
  BOOST_TEST(std::isnan(mean_and_error(numbers{}).mean));
  BOOST_TEST(std::isnan(mean_and_error(numbers{}).standard_error));
  BOOST_TEST(mean_and_error(numbers{7.0}).mean == 7.0);
  BOOST_TEST(std::isnan(mean_and_error(numbers{7.0}).standard_error));
  BOOST_TEST(std::isnan(estimate{}.mean));
}

BOOST_AUTO_TEST_CASE(the_median_is_in_the_middle) {
  BOOST_TEST(median({3.0, 1.0, 2.0}) == 2.0);
  BOOST_TEST(median({4.0, 1.0, 3.0, 2.0}) == 2.5);
  BOOST_TEST(median({INFINITY, 1.0, 2.0}) == 2.0);
  BOOST_TEST(median({INFINITY, 1.0}) == INFINITY);
  BOOST_TEST(median({INFINITY, INFINITY}) == INFINITY);
  BOOST_TEST(std::isnan(median({})));
}

// The numbers n/100 are as uniform as can be: their median has the deviation 1/(2 sqrt(101)), and a farthest
// number does not change that.
BOOST_AUTO_TEST_CASE(the_error_of_a_median_is_that_of_its_place) {
  numbers uniform;
  for (int n = 0; n <= 100; ++n) uniform.push_back(n / 100.0);
  const auto rounding = boost::test_tools::tolerance(1e-14);
  const double error = 0.5 / std::sqrt(101.0);
  BOOST_TEST(median_and_error(uniform).mean == 0.5, rounding);
  BOOST_TEST(median_and_error(uniform).standard_error == error, rounding);
  uniform.back() = INFINITY;
  BOOST_TEST(median_and_error(uniform).standard_error == error, rounding);
  for (std::size_t n = 55; n <= 100; ++n) uniform[n] += 0.1;  // a gap among the places that count
  BOOST_TEST(median_and_error(uniform).mean == 0.5, rounding);
  BOOST_TEST(median_and_error(uniform).standard_error > 1.5 * error);
  BOOST_TEST(std::isnan(median_and_error(numbers{7.0}).standard_error));
}

// A large offset would drown squares that are not centred.
BOOST_AUTO_TEST_CASE(an_offset_does_not_change_the_error) {
  const double offset = 1e8;
  const double error = mean_and_error(numbers{offset + 1.0, offset + 2.0, offset + 3.0}).standard_error;
  BOOST_TEST(error == std::sqrt(1.0 / 3.0), boost::test_tools::tolerance(8 * eps * offset));
}

// The mean of 200 draws is within three errors of the true one but for 0.3 % of cases, and within three
// halves of one but for 13 %.
BOOST_AUTO_TEST_CASE(the_error_is_that_of_the_mean) {
  draws random(seed(1));
  int beyond = 0;
  int beyond_half = 0;
  constexpr int times = 1000;
  for (int n = 0; n < times; ++n) {
    numbers samples;
    for (int i = 0; i < 200; ++i) samples.push_back(random.uniform(-1.0, 1.0));
    const auto [mean, error] = mean_and_error(samples);
    beyond += std::abs(mean) > 3.0 * error;
    beyond_half += std::abs(mean) > 1.5 * error;
  }
  const int allowed = most_of(times, 0.00305, false_alarms);  // Student's, of 199 degrees of freedom: 13
  BOOST_TEST(beyond <= allowed);
  BOOST_TEST(beyond_half > allowed);  // 134 are expected
}

BOOST_AUTO_TEST_CASE(what_two_share_of_chance_cancels) {
  draws random;
  numbers a;
  numbers b;
  for (int i = 0; i < 50; ++i) {
    const double shared = random.uniform(-1.0, 1.0);
    a.push_back(shared + 0.25);
    b.push_back(shared);
  }
  BOOST_TEST(paired_difference(a, b).mean == 0.25, boost::test_tools::tolerance(50 * eps));
  BOOST_TEST(paired_difference(a, b).standard_error <= 50 * eps);
  BOOST_TEST(mean_and_error(a).standard_error > 0.05);
  b[3] = NAN;
  b[4] += 1.0;
  BOOST_TEST(paired_difference(a, b).mean == 0.25 - 1.0 / 49.0, boost::test_tools::tolerance(50 * eps));
}

BOOST_AUTO_TEST_CASE(the_slope_of_a_line_is_its_slope) {
  draws random;
  numbers x;
  numbers y;
  for (int i = 0; i < 20; ++i) {
    x.push_back(random.uniform(-1.0, 1.0));
    y.push_back(3.0 - 2.0 * x.back());
  }
  BOOST_TEST(slope(x, y) == -2.0, boost::test_tools::tolerance(100 * eps));  // 20 terms, a few roundings each
  y[0] += 1.0;
  BOOST_TEST(std::abs(slope(x, y) + 2.0) > 1e-3);
}

BOOST_AUTO_TEST_CASE(the_least_squares_slope_by_hand) {
  BOOST_TEST(slope(numbers{0.0, 1.0, 2.0}, numbers{0.0, 3.0, 3.0}) == 1.5,
             boost::test_tools::tolerance(8 * eps));
}
