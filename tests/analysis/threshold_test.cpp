// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/threshold.hpp"

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using rows = std::vector<error_at>;
const double no_number = std::nan("");

/// 3 x^2 at x = .1, .2, .4, .8, each known to 5 %: it is .3 at x = sqrt(.1), a third of the way from .2 to
/// .4 on the log scale.
rows power_law() {
  rows result;
  for (const double x : {.1, .2, .4, .8}) result.push_back({x, 3.0 * x * x, .05 * 3.0 * x * x});
  return result;
}
const double where = std::sqrt(.1);
const double share = std::log(where / .2) / std::log(2.0);

}  // namespace

BOOST_AUTO_TEST_CASE(a_power_law_crosses_where_it_must) {
  const auto found = threshold(power_law(), .3);
  const auto near = boost::test_tools::tolerance(20 * eps);
  BOOST_TEST((found.kind == crossing_kind::found));
  BOOST_TEST(found.x == where, near);
  BOOST_TEST(found.last_below == .2);
  BOOST_TEST(found.first_above == .4);
  // The slope is 2: 5 % in the error are 2.5 % in x, shared by both ends.
  const double independent = .025 * std::hypot(share, 1.0 - share);
  BOOST_TEST(found.standard_error == where * independent, near);
  BOOST_TEST(threshold(power_law(), .3, 1.0).standard_error == where * .025, near);
  // A level that is met is crossed there.
  BOOST_TEST(threshold(power_law(), power_law()[2].error).x == .4, near);
}

// As costs fall, errors rise.
BOOST_AUTO_TEST_CASE(costs_count_down) {
  rows costs = power_law();
  for (auto& row : costs) row.x = 5.0 / row.x;
  const auto found = threshold(costs, .3);
  BOOST_TEST(found.x == 5.0 / where, boost::test_tools::tolerance(20 * eps));
  const double relative = threshold(power_law(), .3).standard_error / where;
  BOOST_TEST(found.standard_error / found.x == relative, boost::test_tools::tolerance(50 * eps));
}

BOOST_AUTO_TEST_CASE(the_first_crossing_counts) {
  rows bent = power_law();
  bent.push_back({1.6, .1, .0});
  bent.push_back({3.2, 1.0, .0});
  BOOST_TEST(threshold(bent, .3).x == threshold(power_law(), .3).x);
}

BOOST_AUTO_TEST_CASE(what_is_not_crossed_is_bounded) {
  const auto below = threshold(power_law(), 2.0);
  BOOST_TEST((below.kind == crossing_kind::below_all));
  BOOST_TEST(below.x == .8);
  BOOST_TEST(std::isnan(below.first_above));
  const auto above = threshold(power_law(), .01);
  BOOST_TEST((above.kind == crossing_kind::above_from_first));
  BOOST_TEST(above.x == .1);
  BOOST_TEST(std::isnan(above.last_below));
  for (const auto& crossing : {below, above}) BOOST_TEST(std::isnan(crossing.standard_error));
}

BOOST_AUTO_TEST_CASE(what_diverged_is_above_any_level) {
  for (const double diverged : {no_number, static_cast<double>(INFINITY)}) {
    rows some = power_law();
    some[2] = {.4, diverged, no_number};
    const auto found = threshold(some, .3);
    BOOST_TEST((found.kind == crossing_kind::bracketed));
    BOOST_TEST(found.x == .2);
    BOOST_TEST(found.last_below == .2);
    BOOST_TEST(found.first_above == .4);
    BOOST_TEST(std::isnan(found.standard_error));
    BOOST_TEST((threshold(some, .05).kind == crossing_kind::found));  // before that
    some[0].error = diverged;
    BOOST_TEST((threshold(some, .3).kind == crossing_kind::above_from_first));
  }
  rows exact = power_law();
  exact[1].error = 0.0;
  BOOST_TEST((threshold(exact, .3).kind == crossing_kind::bracketed));
}

// 4000 measurements of the law: the crossings scatter as they say, known to 1/sqrt(2 x 4000) = 1.1 %; that
// the logarithm bends at errors of 5 % is (5 %)^2 of it.
BOOST_AUTO_TEST_CASE(crossings_scatter_as_they_say) {
  for (const double correlation : {0.0, 1.0}) {
    double squares = 0.0;
    double said = 0.0;
    constexpr int times = 4000;
    for (std::uint64_t n = 0; n < times; ++n) {
      rows seen = power_law();
      std::array<double, 4> normals{};
      standard_normals(seed(1), {.trajectory = n, .purpose = noise_purpose::initial_state},
                       std::span<double>(normals));
      if (correlation == 1.0) normals.fill(normals[0]);
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i].error += seen[i].standard_error * normals[i];
      const auto found = threshold(seen, .3, correlation);
      squares += (found.x - where) * (found.x - where) / times;
      said += found.standard_error / times;
    }
    const auto near = boost::test_tools::tolerance(standard_errors(false_alarms / 2) * .011 + .0025);
    BOOST_TEST(std::sqrt(squares) == said, near);
    BOOST_TEST(std::sqrt(squares) != .5 * said, near);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const rows& some, double level, auto... words) {
    return refuses<std::invalid_argument>([&] { threshold(some, level); }, {words...});
  };
  BOOST_TEST(refused({}, .3, "0 rows"));
  BOOST_TEST(refused(power_law(), 0.0, "level 0"));
  BOOST_TEST(refused(power_law(), no_number, "level nan"));
  BOOST_TEST(refused({{.1, 1.0, 0.0}, {.1, 2.0, 0.0}}, .3, "row 2", "sorted"));
  BOOST_TEST(refused({{.1, 1.0, 0.0}, {.3, 2.0, 0.0}, {.2, 2.0, 0.0}}, .3, "row 3", "sorted"));
  BOOST_TEST(refused({{-.1, 1.0, 0.0}}, .3, "positive"));
  BOOST_TEST(refused({{.1, -1.0, 0.0}}, .3, "errors >= 0"));
}
