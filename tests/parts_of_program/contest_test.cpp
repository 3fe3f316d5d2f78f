// SPDX-License-Identifier: BSL-1.0
// Who wins a contest: at one error by a cost that differs enough, at one cost by errors that differ by more
// than chance on the trajectories that both share.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "comparison/contest.hpp"

using namespace nysalt::program;

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
