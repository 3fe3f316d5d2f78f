// SPDX-License-Identifier: BSL-1.0
// Means, medians, slopes, tails, Pareto fronts and thresholds, against numbers worked out by hand.
// reach.
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/pareto_front.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/tail.hpp"
#include "nysalt/analysis/threshold.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using numbers = std::vector<double>;
const double no_number = std::nan("");

/// Samples of 1/u^(1/index), u uniform on (0, 1): moments from the order `index` on do not exist.
numbers pareto(draws& random, double index, int count) {
  numbers result;
  for (int i = 0; i < count; ++i) result.push_back(std::pow(random.uniform(0.0, 1.0), -1.0 / index));
  return result;
}

using rows = std::vector<error_at>;
/// 3 x^2 at x = .1, .2, .4, .8, each known to 5 %: it is .3 at x = sqrt(.1), a third of the way from .2 to
/// .4 on the log scale.
rows power_law() {
  rows result;
  for (const double x : {.1, .2, .4, .8}) result.push_back({x, 3.0 * x * x, .05 * 3.0 * x * x});
  return result;
}
const double where = std::sqrt(.1);
const double share = std::log(where / .2) / std::log(2.0);

using indices = std::vector<std::size_t>;
indices front(const std::vector<cost_and_error>& all) { return pareto_front(all); }
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

// Of 0, 0, 0, 4: mean 1, central moments 3 and 6; (sum x)^2/sum x^2 = 1.
BOOST_AUTO_TEST_CASE(a_tail_is_what_its_moments_say) {
  const auto near = boost::test_tools::tolerance(32 * eps);
  const tail found = tail_of(numbers{0.0, NAN, 0.0, 4.0, 0.0});
  BOOST_TEST(found.count == 4.0);
  BOOST_TEST(found.skewness == 6.0 / std::pow(3.0, 1.5), near);
  BOOST_TEST(found.deciding == 1.0, near);
  BOOST_TEST(found.enough() == 25.0 * 36.0 / 27.0, near);
  BOOST_TEST(found.is_heavy());
  BOOST_TEST(std::abs(tail_of(numbers{1.0, 2.0, 3.0}).skewness) < 8 * eps);
  BOOST_TEST(tail_of(numbers{2.0, 2.0, 2.0}).deciding == 3.0);
}

BOOST_AUTO_TEST_CASE(units_do_not_matter) {
  draws random;
  numbers small = pareto(random, 3.0, 100);
  const tail unscaled = tail_of(small);
  for (double& x : small) x *= 0x1p-900;
  BOOST_TEST(tail_of(small).skewness == unscaled.skewness);  // a power of two: to the bit
  BOOST_TEST(tail_of(small).deciding == unscaled.deciding);
}

BOOST_AUTO_TEST_CASE(what_is_equal_or_nothing_has_no_tail) {
  BOOST_TEST(!tail_of(numbers{}).is_heavy());
  BOOST_TEST(!tail_of(numbers{NAN}).is_heavy());
  BOOST_TEST(!tail_of(numbers{0.0, 0.0}).is_heavy());
  BOOST_TEST(!tail_of(numbers{0.1, std::nextafter(0.1, 1.0), 0.1, 0.1}).is_heavy());
  BOOST_TEST(!tail_of(numbers(100, 0.1)).is_heavy());
}

// Without a variance the skewness of a sample grows like the root of its size, and no size is enough; that of
// a uniform law is 0, with a standard error of sqrt(6/400) = .12: .8 is beyond six of them.
BOOST_AUTO_TEST_CASE(a_law_without_variance_is_heavy_at_any_size) {
  draws random(seed(1));
  for (const int count : {100, 400, 6400}) {
    int heavy = 0;
    int light = 0;
    for (int k = 0; k < 20; ++k) {
      heavy += tail_of(pareto(random, 1.2, count)).is_heavy();
      numbers uniform;
      for (int i = 0; i < count; ++i) uniform.push_back(random.uniform(0.0, 1.0));
      light += tail_of(uniform).is_heavy();
    }
    BOOST_TEST_CONTEXT(count << " numbers: " << heavy) {
      BOOST_TEST(20 - heavy <= most_of(20, 0.01, false_alarms / 3));  // each is with a probability above .99
      BOOST_TEST(light == 0);
    }
  }
}

// Exponential numbers have skewness 2: a hundred are just enough, and more are.
BOOST_AUTO_TEST_CASE(a_light_tail_needs_a_larger_sample) {
  draws random(seed(1));
  const auto exponential = [&](int count) {
    numbers result;
    for (int i = 0; i < count; ++i) result.push_back(-std::log(random.uniform(0.0, 1.0)));
    return tail_of(result);
  };
  int too_small = 0;
  for (int k = 0; k < 100; ++k) too_small += exponential(20).enough() > 1.0;
  BOOST_TEST(too_small > 50);
  BOOST_TEST(!exponential(10000).is_heavy());
  const double skewness = exponential(40000).skewness;
  BOOST_TEST(std::abs(skewness - 2.0) < 0.5);
}

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

BOOST_AUTO_TEST_CASE(thresholds_that_cannot_be_are_refused) {
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

BOOST_AUTO_TEST_CASE(who_costs_more_must_err_less) {
  BOOST_TEST(front({{3.0, 1.0}, {1.0, 3.0}, {2.0, 2.0}}) == (indices{1, 2, 0}));
  BOOST_TEST(front({{3.0, 1.0}, {1.0, 3.0}, {2.0, 4.0}}) == (indices{1, 0}));
  BOOST_TEST(front({{1.0, 1.0}, {2.0, 2.0}}) == (indices{0}));
  BOOST_TEST(front({}).empty());
}

BOOST_AUTO_TEST_CASE(of_equals_the_first_is_kept) {
  BOOST_TEST(front({{1.0, 2.0}, {1.0, 2.0}}) == (indices{0}));
  BOOST_TEST(front({{1.0, 3.0}, {1.0, 2.0}}) == (indices{1}));  // as dear, and better
  BOOST_TEST(front({{2.0, 2.0}, {1.0, 2.0}}) == (indices{1}));  // as good, and cheaper
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_never_there) {
  BOOST_TEST(front({{1.0, NAN}, {NAN, 1.0}, {0.5, INFINITY}, {-INFINITY, 1.0}, {2.0, 2.0}}) == (indices{4}));
  BOOST_TEST(front({{1.0, NAN}}).empty());
}

// The definition, pair by pair.
BOOST_AUTO_TEST_CASE(nobody_on_the_front_is_beaten) {
  draws random;
  std::vector<cost_and_error> all(200);
  for (auto& [cost, error] : all) {
    cost = std::round(random.uniform(0.0, 30.0));  // many ties
    error = std::round(random.uniform(0.0, 30.0));
  }
  indices expected;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool beaten = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool as_good = all[k].cost <= all[i].cost && all[k].error <= all[i].error;
      const bool equal = all[k].cost == all[i].cost && all[k].error == all[i].error;
      beaten = beaten || (as_good && (!equal || k < i));
    }
    if (!beaten) expected.push_back(i);
  }
  auto found = front(all);
  BOOST_TEST(found.size() > 2U);
  std::ranges::sort(found);
  BOOST_TEST(found == expected);
}
