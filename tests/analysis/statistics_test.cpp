// SPDX-License-Identifier: BSL-1.0
// Means, medians, slopes, tails, Pareto fronts, thresholds, histograms and their distances, against numbers
// worked out by hand.
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/nysalt.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using numbers = std::vector<double>;
const double no_number = std::nan("");

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

constexpr equal_bins quarters{0.0, 1.0, 4};

using counts = std::vector<std::int64_t>;

histogram of(const numbers& all, const equal_bins& bins = {-2.0, 2.0, 40}) {
  histogram result(bins);
  for (const double x : all) result.add(x);
  return result;
}
counts counts_of(const numbers& all, const equal_bins& bins) {
  const histogram found = of(all, bins);
  return {found.counts().begin(), found.counts().end()};
}

numbers normals(std::size_t n, std::uint64_t number) {
  numbers result(n);
  standard_normals(number, {.purpose = noise_purpose::initial_state}, std::span(result));
  return result;
}

constexpr equal_bins bins{-2.0, 2.0, 40};

/// Of 4000 normal numbers each, independent of each other.
std::vector<histogram> ensembles(std::uint64_t count) {
  std::vector<histogram> result;
  for (std::uint64_t k = 0; k < count; ++k) result.push_back(of(normals(4000, 100 + k)));
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_mean_comes_with_its_error) {
  // A large offset would drown squares that are not centred.
  for (const double offset : {0.0, 1e8}) {
    const auto near = tolerance(8 * eps * (1.0 + offset));
    const auto [mean, error] =
        mean_and_error(numbers{offset + 1.0, offset + 2.0, offset + 3.0, offset + 6.0});
    BOOST_TEST(mean == offset + 3.0, near);
    BOOST_TEST(error == std::sqrt(14.0 / 3.0 / 4.0), near);
  }
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
  const auto rounding = tolerance(1e-14);
  const double error = 0.5 / std::sqrt(101.0);
  BOOST_TEST(detail::median_and_error(uniform).mean == 0.5, rounding);
  BOOST_TEST(detail::median_and_error(uniform).standard_error == error, rounding);
  uniform.back() = INFINITY;
  BOOST_TEST(detail::median_and_error(uniform).standard_error == error, rounding);
  for (std::size_t n = 55; n <= 100; ++n) uniform[n] += 0.1;  // a gap among the places that count
  BOOST_TEST(detail::median_and_error(uniform).mean == 0.5, rounding);
  BOOST_TEST(detail::median_and_error(uniform).standard_error > 1.5 * error);
  BOOST_TEST(std::isnan(detail::median_and_error(numbers{7.0}).standard_error));
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
  BOOST_TEST(paired_difference(a, b).mean == 0.25, tolerance(50 * eps));
  BOOST_TEST(paired_difference(a, b).standard_error <= 50 * eps);
  BOOST_TEST(mean_and_error(a).standard_error > 0.05);
  b[3] = NAN;
  b[4] += 1.0;
  BOOST_TEST(paired_difference(a, b).mean == 0.25 - 1.0 / 49.0, tolerance(50 * eps));
}

BOOST_AUTO_TEST_CASE(the_slope_is_that_of_least_squares) {
  const auto near = tolerance(8 * eps);
  BOOST_TEST(slope(numbers{0.0, 1.0, 2.0}, numbers{0.0, 3.0, 3.0}) == 1.5, near);
  BOOST_TEST(slope(numbers{-0.5, 1.0, 0.25, 2.0}, numbers{4.0, 1.0, 2.5, -1.0}) == -2.0, near);  // a line
}

// Of 0, 0, 0, 4: mean 1, central moments 3 and 6; (sum x)^2/sum x^2 = 1.
BOOST_AUTO_TEST_CASE(a_tail_is_what_its_moments_say) {
  const auto near = tolerance(32 * eps);
  const tail found = tail_of(numbers{0.0, NAN, 0.0, 4.0, 0.0});
  BOOST_TEST(found.count == 4.0);
  BOOST_TEST(found.skewness == 6.0 / std::pow(3.0, 1.5), near);
  BOOST_TEST(found.deciding == 1.0, near);
  BOOST_TEST(found.enough() == 25.0 * 36.0 / 27.0, near);
  BOOST_TEST(found.is_heavy());
  BOOST_TEST(std::abs(tail_of(numbers{1.0, 2.0, 3.0}).skewness) < 8 * eps);
  BOOST_TEST(tail_of(numbers{2.0, 2.0, 2.0}).deciding == 3.0);
  const tail small =
      tail_of(numbers{0.0, 0.0, 0x1p-898, 0.0});  // units do not matter, a power of two to the bit
  BOOST_TEST(small.skewness == found.skewness);
  BOOST_TEST(small.deciding == found.deciding);
  for (const auto& none : {numbers{}, numbers{NAN}, numbers{0.0, 0.0}, numbers(100, 0.1),
                           numbers{0.1, std::nextafter(0.1, 1.0), 0.1, 0.1}}) {
    BOOST_TEST(!tail_of(none).is_heavy());
  }
}

BOOST_AUTO_TEST_CASE(a_power_law_crosses_where_it_must) {
  const auto found = threshold(power_law(), .3);
  const auto near = tolerance(20 * eps);
  BOOST_TEST((found.kind == threshold_crossing::crossing_kind::found));
  BOOST_TEST(found.x == where, near);
  BOOST_TEST(found.last_below == .2);
  BOOST_TEST(found.first_above == .4);
  // The slope is 2: 5 % in the error are 2.5 % in x, shared by both ends.
  const double independent = .025 * std::hypot(share, 1.0 - share);
  BOOST_TEST(found.standard_error == where * independent, near);
  BOOST_TEST(threshold(power_law(), .3, 1.0).standard_error == where * .025, near);
  // A level that is met is crossed there.
  BOOST_TEST(threshold(power_law(), power_law()[2].error).x == .4, near);
  // The first crossing counts.
  rows bent = power_law();
  bent.push_back({1.6, .1, .0});
  bent.push_back({3.2, 1.0, .0});
  BOOST_TEST(threshold(bent, .3).x == found.x);
  // As costs fall, errors rise.
  rows costs = power_law();
  for (auto& row : costs) row.x = 5.0 / row.x;
  const auto of_costs = threshold(costs, .3);
  BOOST_TEST(of_costs.x == 5.0 / where, near);
  BOOST_TEST(of_costs.standard_error / of_costs.x == independent, tolerance(50 * eps));
}

BOOST_AUTO_TEST_CASE(what_is_not_crossed_is_bounded) {
  const auto below = threshold(power_law(), 2.0);
  BOOST_TEST((below.kind == threshold_crossing::crossing_kind::below_all));
  BOOST_TEST(below.x == .8);
  BOOST_TEST(std::isnan(below.first_above));
  const auto above = threshold(power_law(), .01);
  BOOST_TEST((above.kind == threshold_crossing::crossing_kind::above_from_first));
  BOOST_TEST(above.x == .1);
  BOOST_TEST(std::isnan(above.last_below));
  for (const auto& crossing : {below, above}) BOOST_TEST(std::isnan(crossing.standard_error));
}

BOOST_AUTO_TEST_CASE(what_diverged_is_above_any_level) {
  for (const double diverged : {no_number, static_cast<double>(INFINITY)}) {
    rows some = power_law();
    some[2] = {.4, diverged, no_number};
    const auto found = threshold(some, .3);
    BOOST_TEST((found.kind == threshold_crossing::crossing_kind::bracketed));
    BOOST_TEST(found.x == .2);
    BOOST_TEST(found.last_below == .2);
    BOOST_TEST(found.first_above == .4);
    BOOST_TEST(std::isnan(found.standard_error));
    BOOST_TEST((threshold(some, .05).kind == threshold_crossing::crossing_kind::found));  // before that
    some[0].error = diverged;
    BOOST_TEST((threshold(some, .3).kind == threshold_crossing::crossing_kind::above_from_first));
  }
  rows exact = power_law();
  exact[1].error = 0.0;
  BOOST_TEST((threshold(exact, .3).kind == threshold_crossing::crossing_kind::bracketed));
}

BOOST_AUTO_TEST_CASE(thresholds_that_cannot_be_are_refused) {
  const auto refused = [](const rows& some, double level, auto... words) {
    return refuses([&] { threshold(some, level); }, {words...});
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
  BOOST_TEST(front({}).empty());
  BOOST_TEST(front({{1.0, 2.0}, {1.0, 2.0}}) == (indices{0}));  // of equals the first
  BOOST_TEST(front({{1.0, 3.0}, {1.0, 2.0}}) == (indices{1}));  // as dear, and better
  BOOST_TEST(front({{2.0, 2.0}, {1.0, 2.0}}) == (indices{1}));  // as good, and cheaper
  // What is not finite is never there.
  BOOST_TEST(front({{1.0, NAN}, {NAN, 1.0}, {0.5, INFINITY}, {-INFINITY, 1.0}, {2.0, 2.0}}) == (indices{4}));
  BOOST_TEST(front({{1.0, NAN}}).empty());
}

// An edge belongs to the bin above it, the last one to the last bin, and nothing within leaves by rounding.
BOOST_AUTO_TEST_CASE(each_number_falls_into_its_bin) {
  const counts known{1, 1, 2, 0, 1, 2};
  BOOST_TEST((counts_of({-0.1, 0.1, 0.3, 0.4, 0.9, 1.1, 7.0}, quarters) == known));
  BOOST_TEST((counts_of({0.0, 0.25, 0.5, 0.75, 1.0}, quarters) == counts{0, 1, 1, 1, 2, 0}));
  BOOST_TEST((counts_of({-INFINITY, INFINITY}, quarters) == counts{1, 0, 0, 0, 0, 1}));
  BOOST_TEST(histogram(quarters, known).counts() == known, per_element());
  draws random;
  for (int n = 0; n < 1000; ++n) {
    const double low = random.uniform(-1.0, 1.0);
    const equal_bins bins{low, low + random.uniform(0.1, 1.0), 1 + n};
    const auto within = counts_of({bins.low, bins.high, std::nextafter(bins.high, bins.low)}, bins);
    BOOST_TEST(within.front() + within.back() == 0);
    const auto outside =
        counts_of({std::nextafter(bins.low, -INFINITY), std::nextafter(bins.high, INFINITY)}, bins);
    BOOST_TEST(outside.front() == 1);
    BOOST_TEST(outside.back() == 1);
  }
}

// 1000 sums of terms near 1/1000.
BOOST_AUTO_TEST_CASE(the_density_integrates_to_what_is_within) {
  const histogram all = of(normals(1000, 4), {-1.0, 3.0, 8});
  double integral = 0.0;
  for (const double density : all.density()) integral += density * 0.5;
  const auto fractions = all.fractions();
  BOOST_TEST(fractions.front() > 0.1);
  BOOST_TEST(integral + fractions.front() + fractions.back() == 1.0, tolerance(20 * eps));
}

BOOST_AUTO_TEST_CASE(the_distance_by_hand) {
  // Fractions 1/2, 1/2 and 1/4, 3/4; then nothing in common, outside too.
  BOOST_TEST(total_variation(of({0.0, 1.0}), of({0.0, 1.0, 1.0, 1.0})) == 0.25);
  BOOST_TEST(total_variation(of({0.0, 1.0}), of({0.0, 1.0})) == 0.0);
  BOOST_TEST(total_variation(of({0.0}), of({1.0})) == 1.0);
  BOOST_TEST(total_variation(of({-9.0}), of({9.0})) == 1.0);
  BOOST_TEST(total_variation(of({-9.0, 0.0}), of({0.0})) == 0.5);
}

BOOST_AUTO_TEST_CASE(distances_are_means_over_all_pairs) {
  const auto some = ensembles(4);
  const auto apart = [&](int i, int k) {
    return total_variation(some[std::size_t(i)], some[std::size_t(k)]);
  };
  const double of_first = apart(0, 1) + apart(0, 2) + apart(0, 3);
  const double of_all = of_first + apart(1, 2) + apart(1, 3) + apart(2, 3);
  const auto near = tolerance(8 * eps);
  BOOST_TEST(sampling_floor(some) == of_all / 6.0, near);
  BOOST_TEST(mean_total_variation(some[0], std::span(some).subspan(1)) == of_first / 3.0, near);
  BOOST_TEST(of_all / 6.0 != of_first / 3.0, near);
}

// Of ten numbers, each a group, four lie in a bin where the others have none: the distance is the mean of
// zeros and ones, and its jackknife that mean's standard error.
BOOST_AUTO_TEST_CASE(the_error_of_a_distance_by_hand) {
  std::vector<histogram> singles;
  numbers upper;
  for (int n = 0; n < 10; ++n) {
    upper.push_back(n < 4 ? 1.0 : 0.0);
    singles.push_back(of({n < 4 ? 0.5 : -0.5}));
  }
  const std::vector<std::vector<histogram>> lower{{of({-0.5}), of({-0.5, -0.5})}};
  const auto by_hand = mean_total_variation(singles, lower);
  const auto near = tolerance(100 * eps);
  BOOST_TEST(by_hand.mean == 0.4, near);
  BOOST_TEST(by_hand.standard_error == mean_and_error(upper).standard_error, near);
  const std::vector<std::vector<histogram>> and_equal{lower[0], {of({0.5}), of({-0.5})}};
  BOOST_TEST(mean_total_variation(singles, and_equal).mean == (0.4 + 0.1) / 2.0, near);
  singles.push_back(histogram(bins));  // of a group that was lost
  BOOST_TEST(mean_total_variation(singles, lower).standard_error == by_hand.standard_error, near);
  const std::vector<std::vector<histogram>> one_group{{of({-0.5})}};
  BOOST_TEST(std::isnan(mean_total_variation(singles, one_group).standard_error));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_counted_or_compared_is_refused) {
  const auto refused = [](auto&& action, auto... words) { return refuses(action, {words...}); };
  for (const equal_bins& unsound :
       {equal_bins{0.0, 1.0, 0}, equal_bins{0.0, 1.0, 1'000'000}, equal_bins{1.0, 1.0, 4},
        equal_bins{1.0, 0.0, 4}, equal_bins{0.0, no_number, 4}, equal_bins{-INFINITY, 0.0, 4}}) {
    BOOST_TEST(refused([&] { histogram all(unsound); }, "histogram", "bins"));
  }
  const counts too_few{1, 1, 2, 0, 1};
  BOOST_TEST(refused([&] { histogram(quarters, too_few); }, "got 5 for", "4 bins"));
  histogram empty(bins);
  BOOST_TEST(refused([&] { empty.add(no_number); }, "NaN"));
  BOOST_TEST(refused([&] { empty.fractions(); }, "one or more for fractions"));
  BOOST_TEST(refused([&] { empty += histogram(quarters); }, "40 bins", "4 bins"));
  const auto some = ensembles(4);
  const histogram other = of({0.0}, {-2.0, 2.0, 39});
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
