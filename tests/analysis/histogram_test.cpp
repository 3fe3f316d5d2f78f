// SPDX-License-Identifier: BSL-1.0
// Histograms: counts, fractions and densities, and the total variation distance between two of them.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/histogram.hpp"
#include "nysalt/analysis/total_variation.hpp"
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

double normal_law(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// sqrt(n) sup |F_n - F| at the edges of the bins, against the normal distribution around `mean`.
double kolmogorov_smirnov(const histogram& of, double mean) {
  const auto fractions = of.fractions();
  double worst = 0.0;
  double below = 0.0;
  for (int edge = 0; edge <= of.bins().count; ++edge) {
    below += fractions[static_cast<std::size_t>(edge)];
    const double x = of.bins().low + edge * of.bins().width() - mean;
    worst = std::max(worst, std::abs(below - normal_law(x)));
  }
  return worst * std::sqrt(static_cast<double>(of.total()));
}

constexpr equal_bins bins{-2.0, 2.0, 40};
constexpr std::size_t n = 4000;

histogram of(const std::vector<double>& numbers) {
  histogram all(bins);
  for (const double x : numbers) all.add(x);
  return all;
}

/// n normal numbers around a mean, independent for each seed.
histogram normal_around(double mean, std::uint64_t number) {
  auto numbers = normals(n, number);
  for (double& x : numbers) x += mean;
  return of(numbers);
}

std::vector<double> probabilities() {
  std::vector<double> result{normal_law(bins.low)};
  for (int k = 0; k < bins.count; ++k) {
    const double left = bins.low + k * bins.width();
    result.push_back(normal_law(left + bins.width()) - normal_law(left));
  }
  result.push_back(normal_law(bins.low));
  return result;
}

/// p - q of two samples is nearly normal, of variance 2 p (1 - p)/n, and E|x| = sqrt(2/pi) sd.
double expected_floor() {
  double sum = 0.0;
  for (const double p : probabilities()) sum += std::sqrt(p * (1.0 - p) / (std::numbers::pi * n));
  return sum;
}

/// Of one pair: the bins are nearly independent, and Var|x| = (1 - 2/pi) sd^2.
double deviation_of_floor() {
  double sum = 0.0;
  for (const double p : probabilities())
    sum += 0.25 * (1.0 - 2.0 / std::numbers::pi) * 2.0 * p * (1.0 - p) / n;
  return std::sqrt(sum);
}

std::vector<histogram> ensembles(int count) {
  std::vector<histogram> result;
  for (int k = 0; k < count; ++k) result.push_back(normal_around(0.0, 100U + static_cast<unsigned>(k)));
  return result;
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

BOOST_AUTO_TEST_CASE(histograms_that_cannot_be_are_refused) {
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

BOOST_AUTO_TEST_CASE(the_distance_by_hand) {
  // Fractions 1/2, 1/2 and 1/4, 3/4; then nothing in common, outside too.
  BOOST_TEST(total_variation(of({0.0, 1.0}), of({0.0, 1.0, 1.0, 1.0})) == 0.25);
  BOOST_TEST(total_variation(of({0.0, 1.0}), of({0.0, 1.0})) == 0.0);
  BOOST_TEST(total_variation(of({0.0}), of({1.0})) == 1.0);
  BOOST_TEST(total_variation(of({-9.0}), of({9.0})) == 1.0);
  BOOST_TEST(total_variation(of({-9.0, 0.0}), of({0.0})) == 0.5);
}

// Two means d apart: TV = 2 F(d/2) - 1, and the bins merge densities that cross at an edge.
BOOST_AUTO_TEST_CASE(the_distance_of_two_normal_laws) {
  const double expected = 2.0 * normal_law(0.5) - 1.0;
  const double found = total_variation(normal_around(-0.5, 1), normal_around(0.5, 2));
  // The sign of p - q is known in nearly all bins, so that noise is that of one binomial: 2 x 1/(4 n); where
  // it is not, noise adds less than the floor.
  const double tolerance = standard_errors(false_alarms) * std::sqrt(0.5 / n) + 0.25 * expected_floor();
  BOOST_TEST(std::abs(found - expected) < tolerance);
  const double farther = total_variation(normal_around(-0.5, 1), normal_around(0.8, 2));
  BOOST_TEST(std::abs(farther - expected) > tolerance);
}

// Pairs share ensembles: their mean has at most the deviation of one pair, and at least that of 15
// independent.
BOOST_AUTO_TEST_CASE(samples_of_one_law_are_a_floor_apart) {
  const auto some = ensembles(6);
  const double floor = sampling_floor(some);
  const double allowed = standard_errors(false_alarms) * deviation_of_floor();
  BOOST_TEST(std::abs(floor - expected_floor()) < allowed);
  BOOST_TEST(std::abs(2.0 * floor - expected_floor()) > allowed);
}

// The same law is at the floor, and another above it.
BOOST_AUTO_TEST_CASE(a_histogram_is_compared_with_all_ensembles) {
  const auto some = ensembles(6);
  const double floor = sampling_floor(some);
  const double allowed = standard_errors(false_alarms) * deviation_of_floor();
  BOOST_TEST(std::abs(mean_total_variation(normal_around(0.0, 7), some) - floor) < allowed);
  BOOST_TEST(mean_total_variation(normal_around(0.4, 7), some) > floor + allowed);
  BOOST_TEST(mean_total_variation(some[0], std::span(some).subspan(1, 1)) ==
             total_variation(some[0], some[1]));
}

BOOST_AUTO_TEST_CASE(groups_give_the_distance_and_its_error) {
  std::vector<histogram> groups;
  for (unsigned g = 0; g < 20; ++g) groups.push_back(normal_around(0.3, 200 + g));
  histogram all(bins);
  for (const auto& group : groups) all += group;
  const std::vector<std::vector<histogram>> others{ensembles(6), ensembles(3)};
  std::vector<histogram> sums(2, histogram(bins));
  for (std::size_t k = 0; k < 2; ++k) {
    for (const auto& group : others[k]) sums[k] += group;
  }
  const auto found = mean_total_variation(groups, others);
  BOOST_TEST(found.mean == mean_total_variation(all, sums));
  BOOST_TEST(found.standard_error > 0.0);
}

// Of ten numbers, each a group, four lie in a bin where the others have none: the distance is the mean of
// zeros and ones, and its jackknife that mean's standard error.
BOOST_AUTO_TEST_CASE(the_error_of_a_distance_by_hand) {
  std::vector<histogram> singles;
  std::vector<double> upper;
  for (int n = 0; n < 10; ++n) {
    upper.push_back(n < 4 ? 1.0 : 0.0);
    singles.push_back(of({n < 4 ? 0.5 : -0.5}));
  }
  const std::vector<std::vector<histogram>> lower{{of({-0.5}), of({-0.5, -0.5})}};
  const auto by_hand = mean_total_variation(singles, lower);
  const auto near = boost::test_tools::tolerance(100 * eps);
  BOOST_TEST(by_hand.mean == 0.4, near);
  BOOST_TEST(by_hand.standard_error == mean_and_error(upper).standard_error, near);
  singles.push_back(histogram(bins));  // of a group that was lost
  BOOST_TEST(mean_total_variation(singles, lower).standard_error == by_hand.standard_error, near);
  const std::vector<std::vector<histogram>> one_group{{of({-0.5})}};
  BOOST_TEST(std::isnan(mean_total_variation(singles, one_group).standard_error));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_compared_is_refused) {
  const auto some = ensembles(4);
  const histogram empty(bins);
  histogram other({-2.0, 2.0, 39});
  other.add(0.0);
  const auto refused = [](auto&& action, auto... words) {
    return refuses<std::invalid_argument>(action, {words...});
  };
  BOOST_TEST(refused([&] { total_variation(some[0], other); }, "40 bins", "39"));
  BOOST_TEST(refused([&] { total_variation(some[0], empty); }, "one or more for fractions"));
  BOOST_TEST(refused([&] { sampling_floor(std::span(some).first(3)); }, "4 or more", "got 3"));
  BOOST_TEST(refused([&] { mean_total_variation(some[0], {}); }, "to compare with must be"));
  BOOST_TEST(sampling_floor(some) > 0.0);
  const std::vector<std::vector<histogram>> nothing{{}};
  BOOST_TEST(refused([&] { mean_total_variation(some, nothing); }, "groups of trajectories must be"));
  BOOST_TEST(
      refused([&] { mean_total_variation(some, std::span(nothing).first(0)); }, "to compare with must be"));
}
