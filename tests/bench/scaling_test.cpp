// SPDX-License-Identifier: BSL-1.0
// The cost model that ./dev scaling fits.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../../bench/scaling/report/cost_model.hpp"
#include "../support/ranks_as_threads.hpp"
#include "nysalt/shard.hpp"

using namespace nysalt;
using namespace nysalt::bench;
using namespace nysalt::test;

namespace {

/// T = 2e-9 x_0 + 3e-6 x_1, each a little off by a part that changes sign.
std::vector<observation> some_times(double off) {
  std::vector<observation> result;
  for (const double pairs : {1e3, 1e4, 1e5, 1e6}) {
    for (const double sign : {-1.0, 1.0}) {
      result.push_back({{pairs, 1.0}, (2e-9 * pairs + 3e-6) * (1.0 + sign * off)});
    }
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(costs_are_found_again) {
  const auto exact = fitted_costs(some_times(0.0));
  // Rounding alone, in columns of one size.
  BOOST_TEST(std::abs(exact[0].value / 2e-9 - 1.0) < 1e-12);
  BOOST_TEST(std::abs(exact[1].value / 3e-6 - 1.0) < 1e-12);
  const auto rough = fitted_costs(some_times(0.01));
  BOOST_TEST(std::abs(rough[0].value - 2e-9) < 3.0 * rough[0].standard_error);
  // Four pairs of times 1 % off tell the cost of a pair to some .01/sqrt(4).
  BOOST_TEST(rough[0].standard_error > 0.003 * 2e-9);
  BOOST_TEST(rough[0].standard_error < 0.03 * 2e-9);
}

BOOST_AUTO_TEST_CASE(no_cost_is_negative) {
  // y falls with x_1, which would be the negative cost.
  const auto found = fitted_costs({{{1.0, 0.0}, 1.0}, {{1.0, 1.0}, 0.9}, {{2.0, 1.0}, 1.9}});
  BOOST_TEST(found[1].value == 0.0);
  BOOST_TEST(found[0].value > 0.9);
  BOOST_CHECK_THROW(fitted_costs({{{1.0, 0.0}, 1.0}}), std::runtime_error);
  BOOST_CHECK_THROW(fitted_costs({}), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(shares_are_those_of_shard) {
  for (const std::int64_t total : {1, 17, 1000, 65'536, 100'003, 10'000'019}) {
    for (const int ranks : {1, 2, 3, 7, 64, 1000}) {
      std::int64_t most = 0;
      const thread_communicator one = rank_alone(0, ranks);
      const shard all(total, one);
      for (int r = 0; r < ranks; ++r) most = std::max(most, all.first_of(r + 1) - all.first_of(r));
      BOOST_TEST(largest_share_of(total, ranks) == most);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_sum_takes_a_level_more_where_ranks_double) {
  for (const auto& [ranks, levels] : {std::pair{1, 0}, {2, 1}, {5, 3}, {10'000, 14}}) {
    BOOST_TEST(levels_over(ranks) == levels);
  }
  BOOST_TEST(bytes_of_pass(2) == 8.0 * 6.0);
  BOOST_TEST(bytes_of_pass(10) == 8.0 * 66.0);
  const reduction_costs costs{{0.5, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {0.25, 0.0}};
  BOOST_TEST(costs.seconds(1, 8.0) == 0.5);
  BOOST_TEST(costs.seconds(16, 8.0) == 0.5 + 4.0 * (1.0 + 2.0));
}
