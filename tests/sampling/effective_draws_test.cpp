// SPDX-License-Identifier: BSL-1.0
// Effective draws are not too many, however short the chains and however long their memory.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../support/autoregression.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/autocovariance.hpp"
#include "nysalt/analysis/integrated_time.hpp"
#include "nysalt/hmc.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using chains = std::vector<std::vector<double>>;

constexpr double memories[] = {-0.9, -0.5, 0.0, 0.5, 0.9, 0.97};
constexpr int lengths[] = {20, 50, 100, 200, 500, 2000};
constexpr int repetitions = 50;

/// Four chains of a memory, tau = (1 + phi)/(1 - phi), the n-th of a seed.
chains autoregressions(double phi, std::uint64_t of_seed, std::uint64_t n, int length) {
  chains all(4);
  for (std::uint64_t k = 0; k < 4; ++k) {
    autoregression<double> next(phi, of_seed, 4 * n + k);
    for (int i = 0; i < length; ++i) all[k].push_back(next.next());
  }
  return all;
}

/// How many times too many the effective draws are, at most, over all lengths and memories.
template <class Count>
double worst_ratio(std::uint64_t of_seed, Count count) {
  double worst = 0.0;
  std::uint64_t number = 0;
  for (const double phi : memories) {
    for (const int length : lengths) {
      const double expected = 4.0 * length * (1.0 - phi) / (1.0 + phi);
      for (int n = 0; n < repetitions; ++n) {
        const double found = count(autoregressions(phi, of_seed, number++, length));
        if (std::isfinite(found)) worst = std::max(worst, found / expected);
      }
    }
  }
  return worst;
}
}  // namespace

// An estimate z of its errors e tau below tau is tau (1 - z e), and counts as 2 e tau at least: it is too
// small by a factor of (2 + z)/2 at most, where the two are equal.
BOOST_AUTO_TEST_CASE(effective_draws_stay_below_their_bound) {
  const double z = standard_errors(false_alarms / (6 * 6 * repetitions));
  BOOST_TEST(worst_ratio(seed(1), [](const chains& all) { return effective_draws(all); }) < 0.5 * (2.0 + z));
}

// Draws over an estimated tau, without that floor.
BOOST_AUTO_TEST_CASE(draws_over_an_estimated_time_exceed_the_bound) {
  const auto plain = [](const chains& all) {
    std::vector<autocovariance_sums> groups;
    for (const auto& chain : all) {
      autocovariance_along<double> sums(static_cast<int>(chain.size() / 3), 0.0);
      for (const double x : chain) sums.add(x);
      groups.push_back(sums.in_lane(0));
    }
    const auto time =
        integrated_autocorrelation_time(autocovariance(1.0, 0.0, std::move(groups)).normalised());
    return time.enough ? 4.0 * static_cast<double>(all[0].size()) / time.tau : NAN;
  };
  BOOST_TEST(worst_ratio(seed(1), plain) > 8.0);
}

// Of chains that are long enough the floor does not count.
BOOST_AUTO_TEST_CASE(long_chains_count_as_they_should) {
  for (const double phi : {-0.3, 0.0, 0.9}) {
    const double expected = 4.0 * 20'000 * (1.0 - phi) / (1.0 + phi);
    const double found = effective_draws(autoregressions(phi, seed(2), 0, 20'000));
    // tau is known to sqrt((4 W + 2)/80000), W = 5 (1 + |phi|)/(1 - |phi|) rounded up.
    const double window = 1.0 + 5.0 * (1.0 + std::abs(phi)) / (1.0 - std::abs(phi));
    const double error = std::sqrt((4.0 * window + 2.0) / 80'000.0);
    const double z = standard_errors(false_alarms / 3);
    BOOST_TEST(found / expected < 1.0 / (1.0 - z * error));
    BOOST_TEST(found / expected > 1.0 / (1.0 + z * error));
  }
}
