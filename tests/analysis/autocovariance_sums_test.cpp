// SPDX-License-Identifier: BSL-1.0
// What is added up along the way is what the definition gives afterwards.
#include "nysalt/analysis/autocovariance_sums.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <tuple>
#include <vector>

#include "../support/allocations.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = std::vector<double>;

numbers random_walk(int samples, double offset) {
  draws random;
  numbers x{random.uniform(-1.0, 1.0)};
  while (std::ssize(x) < samples) x.push_back(0.9 * x.back() + random.uniform(-1.0, 1.0));
  for (double& value : x) value += offset;
  return x;
}

/// By the definition, term by term.
pair_sums by_definition(const numbers& x, std::size_t lag, double centre) {
  pair_sums sum;
  for (std::size_t t = 0; t + lag < x.size(); ++t) {
    const double head = x[t] - centre;
    const double tail = x[t + lag] - centre;
    sum = sum + pair_sums{1.0, head * tail, head, tail};
  }
  return sum;
}

template <class T>
autocovariance_sums along(const numbers& x, int lags, double centre, int k = 0) {
  autocovariance_along<T> sums(lags, centre);
  for (const double value : x) {
    T all(-3.0);
    set_lane(all, k, value);
    sums.add(all);
  }
  return sums.in_lane(k);
}

bool same(const autocovariance_sums& a, const autocovariance_sums& b) {
  const auto equal = [](const pair_sums& x, const pair_sums& y) {
    return x.pairs == y.pairs && x.products == y.products && x.heads == y.heads && x.tails == y.tails;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

}  // namespace

// As many samples as may be, and a few more: whole intervals and rests, barely more samples than lags.
BOOST_AUTO_TEST_CASE(sums_are_those_of_the_definition) {
  for (const int lags : {1, 3, 8, 20}) {
    for (const int samples : {lags + 1, lags + 2, lags + 7, lags + 8, 100}) {
      const auto x = random_walk(samples, 0.3);
      const auto sums = along<double>(x, lags, 0.3);
      // Values below 10, and a rounding a term, twice for heads and tails.
      const double rounding = 200.0 * samples * eps;
      for (std::size_t lag = 0; lag < sums.size(); ++lag) {
        const auto expected = by_definition(x, lag, 0.3);
        BOOST_TEST(sums[lag].pairs == expected.pairs);
        BOOST_TEST(sums[lag].products == expected.products);  // the same terms in the same order
        BOOST_TEST(std::abs(sums[lag].heads - expected.heads) <= rounding);
        BOOST_TEST(std::abs(sums[lag].tails - expected.tails) <= rounding);
      }
      // Heads are not tails, else the test could not tell.
      BOOST_TEST(std::abs(sums[1].heads - sums[1].tails) > rounding);
    }
  }
}

using scalars = std::tuple<double, pack<double, 3>, pack<double, 8>, pack<double, 16>>;
BOOST_AUTO_TEST_CASE_TEMPLATE(lanes_do_not_change_a_bit, T, scalars) {
  const auto x = random_walk(203, 0.1);
  const auto expected = along<double>(x, 17, 0.2);
  BOOST_TEST(same(along<T>(x, 17, 0.2), expected));
  BOOST_TEST(same(along<T>(x, 17, 0.2, lanes_in<T> - 1), expected));
  BOOST_TEST(!same(along<T>(x, 17, 0.1), expected));
}

BOOST_AUTO_TEST_CASE(asking_does_not_change_the_sums) {
  const auto x = random_walk(50, 0.0);
  autocovariance_along<double> asked(5, 0.0);
  for (std::size_t t = 0; t < x.size(); ++t) {
    asked.add(x[t]);
    if (t == 20 || t == 21) asked.in_lane(0);
  }
  BOOST_TEST(same(asked.in_lane(0), along<double>(x, 5, 0.0)));
}

// With an offset of 1e6 and a variance near 1, the samples keep 1e-10, and so do sums about a centre; sums
// about zero keep no more than 1e12 eps a term, and its mean over 1000 roundings is off by 1e-5 at least.
BOOST_AUTO_TEST_CASE(a_centre_keeps_the_digits) {
  const auto x = random_walk(1000, 0.0);
  const auto far = random_walk(1000, 1e6);
  const auto error = [&](double centre) {
    return std::abs(along<double>(far, 3, centre)[1].covariance() - by_definition(x, 1, 0.0).covariance());
  };
  BOOST_TEST(error(1e6 + 2.0) < 1e-8);  // 2 x 5 x 1e-10, and 5 of a centre that is not the mean
  BOOST_TEST(error(0.0) > 1e-6);
}

BOOST_AUTO_TEST_CASE(memory_does_not_grow_with_time) {
  autocovariance_along<pack<double, 8>> sums(50, 0.0);
  const auto before = allocations;
  for (int t = 0; t < 10'000; ++t) sums.add(pack<double, 8>(1.0));
  BOOST_TEST(allocations == before);
  BOOST_TEST(sums.in_lane(3)[50].products == 9950.0);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](auto&& action, auto... words) {
    return refuses<std::invalid_argument>(action, {words...});
  };
  BOOST_TEST(refused([] { autocovariance_along<double>(0, 0.0); }, "got 0"));
  BOOST_TEST(refused([] { autocovariance_along<double>(1'000'000, 0.0); }, "got 1000000"));
  BOOST_TEST(refused([] { autocovariance_along<double>(3, std::nan("")); }, "centre"));
  BOOST_TEST(refused([] { along<double>({1.0, 2.0, 3.0}, 3, 0.0); }, "3 lags", "got 3"));
}
