// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/histogram.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr equal_bins quarters{0.0, 1.0, 4};

std::vector<std::int64_t> counts_of(const std::vector<double>& numbers, const equal_bins& bins) {
  histogram all(bins);
  for (const double x : numbers) all.add(x);
  return {all.counts().begin(), all.counts().end()};
}
using counts = std::vector<std::int64_t>;

std::vector<double> normals(std::size_t n, std::uint64_t number) {
  std::vector<double> numbers(n);
  standard_normals(seed(number), {.purpose = noise_purpose::initial_state}, std::span(numbers));
  return numbers;
}

/// sqrt(n) sup |F_n - F| at the edges of the bins, against the normal distribution around `mean`.
double kolmogorov_smirnov(const histogram& of, double mean) {
  const auto fractions = of.fractions();
  double worst = 0.0;
  double below = 0.0;
  for (int edge = 0; edge <= of.bins().count; ++edge) {
    below += fractions[static_cast<std::size_t>(edge)];
    const double x = of.bins().low + edge * of.bins().width() - mean;
    worst = std::max(worst, std::abs(below - 0.5 * std::erfc(-x / std::sqrt(2.0))));
  }
  return worst * std::sqrt(static_cast<double>(of.total()));
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_number_falls_into_its_bin) {
  BOOST_TEST((counts_of({-0.1, 0.1, 0.3, 0.4, 0.9, 1.1, 7.0}, quarters) == counts{1, 1, 2, 0, 1, 2}));
}

// An edge belongs to the bin above it, the last one to the last bin, and nothing within leaves by rounding.
BOOST_AUTO_TEST_CASE(edges_have_their_bin) {
  BOOST_TEST((counts_of({0.0, 0.25, 0.5, 0.75, 1.0}, quarters) == counts{0, 1, 1, 1, 2, 0}));
  BOOST_TEST((counts_of({-infinity, infinity}, quarters) == counts{1, 0, 0, 0, 0, 1}));
  draws random;
  for (int n = 0; n < 1000; ++n) {
    const double low = random.uniform(-1.0, 1.0);
    const equal_bins bins{low, low + random.uniform(0.1, 1.0), 1 + n};
    const auto within = counts_of({bins.low, bins.high, std::nextafter(bins.high, bins.low)}, bins);
    BOOST_TEST(within.front() + within.back() == 0);
    const auto outside =
        counts_of({std::nextafter(bins.low, -infinity), std::nextafter(bins.high, infinity)}, bins);
    BOOST_TEST(outside.front() == 1);
    BOOST_TEST(outside.back() == 1);
  }
}

BOOST_AUTO_TEST_CASE(counts_that_are_known_make_a_histogram) {
  const counts known{1, 1, 2, 0, 1, 2};
  const histogram all(quarters, known);
  BOOST_TEST(all.counts() == known, boost::test_tools::per_element());
  const counts too_few{1, 1, 2, 0, 1};
  BOOST_TEST(refuses<std::invalid_argument>([&] { histogram(quarters, too_few); }, {"got 5 for", "4 bins"}));
}

BOOST_AUTO_TEST_CASE(histograms_add_up_in_any_order) {
  const auto numbers = normals(1000, 3);
  histogram whole({-2.0, 2.0, 30});
  histogram odd = whole;
  histogram even = whole;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    whole.add(numbers[i]);
    (i % 2 == 0 ? even : odd).add(numbers[i]);
  }
  const histogram alone = odd;
  odd += even;
  BOOST_TEST(odd.counts() == whole.counts(), boost::test_tools::per_element());
  odd -= even;
  BOOST_TEST(odd.counts() == alone.counts(), boost::test_tools::per_element());
  BOOST_TEST(whole.total() == 1000);
}

// 1000 sums of terms near 1/1000.
BOOST_AUTO_TEST_CASE(the_density_integrates_to_what_is_within) {
  histogram all({-1.0, 3.0, 8});
  for (const double x : normals(1000, 4)) all.add(x);
  double integral = 0.0;
  for (const double density : all.density()) integral += density * 0.5;
  const auto fractions = all.fractions();
  BOOST_TEST(fractions.front() > 0.1);
  BOOST_TEST(integral + fractions.front() + fractions.back() == 1.0, boost::test_tools::tolerance(20 * eps));
}

BOOST_AUTO_TEST_CASE(normal_numbers_have_the_normal_law) {
  histogram all({-3.0, 3.0, 60});
  for (const double x : normals(40'000, 5)) all.add(x);
  const double allowed = kolmogorov_smirnov_limit(false_alarms);
  BOOST_TEST(kolmogorov_smirnov(all, 0.0) < allowed);
  BOOST_TEST(kolmogorov_smirnov(all, 0.1) > allowed);  // 200 x .1 x .4 = 8
}

// Lane by lane, what one trajectory would give: NaN and what lies outside in other lanes do not matter.
BOOST_AUTO_TEST_CASE(lanes_count_as_alone) {
  using T = pack<double, 8>;
  const equal_bins bins{-1.5, 1.0, 77};
  histogram_along<T> together(bins);
  std::vector<histogram> alone(8, histogram(bins));
  const auto numbers = normals(8000, 6);
  for (std::size_t i = 0; i < numbers.size(); i += 8) {
    T x(0.0);
    for (int k = 0; k < 8; ++k) {
      const double number = numbers[i + static_cast<std::size_t>(k)];
      x.set(k, k == 5 ? std::nan("") : number);
      alone[static_cast<std::size_t>(k)].add(number);
    }
    together.add(x);
  }
  for (int k = 0; k < 8; ++k) {
    const auto expected = alone[static_cast<std::size_t>(k)].counts();
    const auto found = together.in_lane(k).counts();
    BOOST_TEST(std::equal(found.begin(), found.end(), expected.begin()) == (k != 5));
    BOOST_TEST(together.in_lane(k).total() == 1000);
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const equal_bins& bins) {
    return refuses<std::invalid_argument>([&] { histogram all(bins); }, {"histogram", "bins"});
  };
  BOOST_TEST(refused({0.0, 1.0, 0}));
  BOOST_TEST(refused({0.0, 1.0, 1'000'000}));
  BOOST_TEST(refused({1.0, 1.0, 4}));
  BOOST_TEST(refused({1.0, 0.0, 4}));
  BOOST_TEST(refused({0.0, std::nan(""), 4}));
  BOOST_TEST(refused({-infinity, 0.0, 4}));
  histogram all(quarters);
  BOOST_TEST(refuses<std::invalid_argument>([&] { all.add(std::nan("")); }, {"NaN"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { all.fractions(); }, {"one or more for fractions"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { all += histogram({0.0, 1.0, 5}); }, {"4 bins", "5 bins"}));
}
