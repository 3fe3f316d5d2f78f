// SPDX-License-Identifier: BSL-1.0
// The number of trajectories is doubled until they are enough, or the most that may be.
#include <boost/test/unit_test.hpp>

#include <limits>
#include <vector>

#include "../support/refusal.hpp"
#include "nysalt/learning/until_enough.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The excess over a loss of 2 is `of_one`/M, and a tenth of the trajectories decide.
enough_course course_of(double of_one, std::int64_t first, const enough_options& options,
                        std::vector<std::int64_t>* asked = nullptr) {
  return until_enough(first, options, [&](std::int64_t trajectories) {
    if (asked != nullptr) asked->push_back(trajectories);
    fit_summary fit;
    fit.loss = 2.0;
    fit.expected_excess = of_one / static_cast<double>(trajectories);
    fit.deciding_trajectories = 0.1 * static_cast<double>(trajectories);
    return fit;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_stops_where_the_share_is_met) {
  std::vector<std::int64_t> asked;
  const auto course = course_of(6.0, 25, {.share = 0.01}, &asked);  // 3/M
  BOOST_TEST((asked == std::vector<std::int64_t>{25, 50, 100, 200, 400}));
  BOOST_TEST(course.is_reached);
  BOOST_TEST(course.stops.back().trajectories == 400);
  BOOST_TEST(course.stops.back().share == 0.0075);
  BOOST_TEST(course.stops.size() == asked.size());
  BOOST_TEST(course.report() == "400 trajectories are enough");
  BOOST_TEST(course_of(6.0, 300, {.share = 0.01}).stops.size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_share_that_rests_on_a_few_trajectories_does_not_count) {
  const auto course = course_of(1e-9, 25, {.share = 0.01});
  BOOST_TEST(course.is_reached);
  BOOST_TEST(course.stops.back().trajectories == 100);
  BOOST_TEST(course.stops.back().deciding == 10.0);
  const auto cut_short = course_of(1e-9, 25, {.share = 0.01, .most = 90});
  BOOST_TEST(!cut_short.is_reached);
  BOOST_TEST(cut_short.report().find("rests on 9 of them") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(it_says_where_the_share_is_not_met) {
  const auto course = course_of(6.0, 25, {.share = 0.01, .most = 130});
  BOOST_TEST(!course.is_reached);
  BOOST_TEST(course.stops.back().trajectories == 130);  // the last doubling is cut short
  BOOST_TEST(course.stops.size() == 4U);
  BOOST_TEST(course.report().find("130 trajectories are not enough") != std::string::npos);
  BOOST_TEST(course.report().find("0.023 of the loss") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_told_is_not_waited_for) {
  const auto course = course_of(std::numeric_limits<double>::quiet_NaN(), 25, {});
  BOOST_TEST(!course.is_reached);
  BOOST_TEST(course.stops.size() == 1U);
}

// What is learned exactly has neither loss nor excess, but rounding of both.
BOOST_AUTO_TEST_CASE(an_exact_fit_has_enough) {
  fit_summary fit;
  fit.loss = 1e-28;
  fit.expected_excess = 1e-28;
  BOOST_TEST(fit.excess_share() == 0.0);
  BOOST_TEST(!fit.is_decided_by_few());
  fit.loss = 1e-20;
  fit.expected_excess = 1e-21;
  BOOST_TEST(fit.excess_share() == 0.1, boost::test_tools::tolerance(1e-15));
  BOOST_TEST(fit.is_decided_by_few());
}

BOOST_AUTO_TEST_CASE(a_share_and_numbers_must_be_possible) {
  const auto refused = [](std::int64_t first, const enough_options& options) {
    return refuses<std::invalid_argument>([&] { course_of(1.0, first, options); }, {"until_enough", "share"});
  };
  BOOST_TEST(refused(25, {.share = 0.0}));
  BOOST_TEST(refused(25, {.share = std::numeric_limits<double>::quiet_NaN()}));
  BOOST_TEST(refused(1, {}));
  BOOST_TEST(refused(25, {.most = 24}));
}
