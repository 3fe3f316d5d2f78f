// SPDX-License-Identifier: BSL-1.0
// Who wins a contest: at one error by a cost that differs enough, at one cost by errors that differ by more
// than chance on the trajectories that both share. Intervals of their ratios, and bounds of errors, hold as
// often as they say.
#include "../../src/comparison/contest.hpp"
#include "../../src/comparison/paired_ratio.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"

using namespace nysalt::program;
using nysalt::test::false_alarms;
using nysalt::test::most_of;
using nysalt::test::seed;

namespace {

candidate of(bool learned, double cost, std::vector<double> scores) {
  candidate result{};
  if (learned) result.source.family = "fg4";
  result.evaluations_per_time = cost;
  result.error.scores = std::move(scores);
  return result;
}

std::string verdict_of(std::optional<double> budget, candidate learned, candidate classical) {
  contest all{.unit = cost_unit::evaluations,
              .budget = budget,
              .cost_ratio = 1.05,
              .statistic = {.is_root = false, .is_quantile = false},
              .all = {std::move(learned), std::move(classical)}};
  all.rank();
  return all.verdict();
}

constexpr error_statistic root_mean{true, false};
constexpr error_statistic mean{false, false};
constexpr error_statistic quantile{false, true};

/// Scores of two methods on the same trajectories: lognormal, of deviation `width` in the logarithm, most of
/// which they share; those of the first are `ratio` times as large.
struct pair_of_methods {
  std::vector<double> a;
  std::vector<double> b;
};
pair_of_methods drawn(std::mt19937_64& draw, int n, double width, double ratio) {
  std::normal_distribution<double> normal;
  pair_of_methods result;
  for (int i = 0; i < n; ++i) {
    const double shared = normal(draw);
    const auto one = [&] {
      return std::exp(width * (0.95 * shared + std::sqrt(1 - 0.95 * 0.95) * normal(draw)));
    };
    result.a.push_back(ratio * one());
    result.b.push_back(one());
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(at_one_error_costs_within_the_tolerance_tie) {
  const std::vector<double> same{1.0, 1.0};
  const auto costs = [&](double learned, double classical) {
    return verdict_of({}, of(true, learned, same), of(false, classical, same));
  };
  BOOST_TEST(costs(100.0, 106.0) == "learned");
  BOOST_TEST(costs(100.0, 104.0) == "tie");
  BOOST_TEST(costs(104.0, 100.0) == "tie");
  BOOST_TEST(costs(106.0, 100.0) == "classical");
}

// Errors of trajectories differ by a factor of 100, those of two methods on one of them by 10 %: of 40 the
// means are known to 30 %, and their ratio exactly.
BOOST_AUTO_TEST_CASE(at_one_cost_scores_of_the_same_trajectories_are_paired) {
  std::mt19937_64 draw(1);
  std::uniform_real_distribution<double> exponent(-2.0, 0.0);
  std::vector<double> less;
  std::vector<double> more;
  for (int n = 0; n < 40; ++n) {
    less.push_back(std::pow(10.0, exponent(draw)));
    more.push_back(1.1 * less.back());
  }
  const auto errors = [&](const std::vector<double>& learned, const std::vector<double>& classical) {
    return verdict_of(10.0, of(true, 10.0, learned), of(false, 10.0, classical));
  };
  BOOST_TEST(errors(less, more) == "learned");
  BOOST_TEST(errors(more, less) == "classical");
  BOOST_TEST(errors(less, less) == "tie");
  // Of other trajectories, in another order, nothing is known.
  BOOST_TEST(errors({less.rbegin(), less.rend()}, more) == "tie");
}

BOOST_AUTO_TEST_CASE(who_diverged_cannot_win) {
  candidate lost = of(true, 1.0, {1e-9, 1e-9});
  lost.error.diverged = 1;
  BOOST_TEST(verdict_of({}, lost, of(false, 2.0, {1.0, 1.0})) == "classical");
}

// 400 samples: an interval of 95 % misses 20 of them; the bootstrap of a hundred trajectories may miss half
// as often again.
BOOST_AUTO_TEST_CASE(the_interval_covers_the_ratio) {
  int misses_of_both = 0;
  for (const auto& statistic : {mean, quantile}) {
    std::mt19937_64 draw(seed(5));
    int misses = 0;
    double width = 0.0;
    constexpr int times = 400;
    for (int k = 0; k < times; ++k) {
      const auto [a, b] = drawn(draw, 100, 0.5, 3.0);
      const auto found = paired_ratio(a, b, statistic);
      misses += found.low > 3.0 || found.high < 3.0;
      width += (found.high - found.low) / times;
    }
    BOOST_TEST(misses <= most_of(times, 0.075, false_alarms / 2));
    BOOST_TEST(width < 1.5);
    misses_of_both += misses;
  }
  // Intervals that never miss say nothing. Those of means miss 20 times, and of quantiles hardly: that none
  // of them misses has a probability below exp(-20).
  BOOST_TEST(misses_of_both >= 1);
}

BOOST_AUTO_TEST_CASE(a_root_is_the_root_and_equal_methods_tie) {
  std::mt19937_64 draw(7);
  const auto [a, b] = drawn(draw, 50, 0.3, 4.0);
  BOOST_TEST(paired_ratio(a, b, root_mean).value == std::sqrt(paired_ratio(a, b, mean).value),
             boost::test_tools::tolerance(1e-12));
  const auto same = paired_ratio(a, a, mean);
  BOOST_TEST(same.low == 1.0);
  BOOST_TEST(same.high == 1.0);
  BOOST_TEST(!same.is_above_one());
  BOOST_TEST(!same.is_below_one());
  const std::vector<double> one{1.0};
  const std::vector<double> two{2.0};
  BOOST_TEST(paired_ratio(two, one, mean).value == 2.0);
  BOOST_TEST(!paired_ratio(two, one, mean).is_above_one());
}

// Of n numbers n p lie below the quantile, give or take sqrt(n p (1 - p)): two of these to either side.
BOOST_AUTO_TEST_CASE(bounds_are_two_standard_errors_away_and_those_of_a_quantile_are_scores) {
  std::vector<double> scores;
  for (int n = 1000; n > 0; --n) scores.push_back(n);
  BOOST_TEST(quantile(scores) == 950.0);
  BOOST_TEST(quantile.upper_bound(scores) == 964.0);  // 950 + 13.8, the next
  BOOST_TEST(quantile.lower_bound(scores) == 936.0);
  scores.resize(100);  // 1000 to 901: the 99.4th is the largest
  BOOST_TEST(quantile.upper_bound(scores) == 1000.0);
  const double error = 2.0 * std::sqrt(14.0 / 3.0 / 4.0);
  const auto near = boost::test_tools::tolerance(1e-14);
  BOOST_TEST(mean.upper_bound({1.0, 2.0, 3.0, 6.0}) == 3.0 + error, near);
  BOOST_TEST(root_mean.lower_bound({1.0, 2.0, 3.0, 6.0}) == std::sqrt(3.0 - error), near);
  BOOST_TEST(mean.lower_bound({0.0, 0.0, 0.0, 1.0}) == 0.0);
}
