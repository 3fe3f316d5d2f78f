// SPDX-License-Identifier: BSL-1.0
// Margins, stable steps and touching windows in closed form, and the Bernstein polynomials that enclose
// trace/2.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/bernstein.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/stability_margin.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;
using boost::test_tools::tolerance;

namespace {

using windows = std::vector<stability_window>;

const windows of_verlet{{0.0, 2.0}};
/// Of the two-stage word (1/2, 2/5).
const double end = std::sqrt(20.0 / 3.0);
const double again = std::sqrt(10.0);
const double last = std::sqrt(50.0 / 3.0);
const windows with_a_gap{{0.0, end}, {again, last}};

stability_chart chart_of(const std::string& letters, const std::vector<double>& c) {
  return chart_stability(run_time_word(letters), c);
}

/// n steps of symplectic Euler, each 1/n of the whole.
stability_chart chart_of_eulers(std::size_t n) {
  std::string letters;
  for (std::size_t i = 0; i < n; ++i) letters += "AB";
  return chart_of(letters, std::vector<double>(2 * n, 1.0 / static_cast<double>(n)));
}

/// (x - r_1) (x - r_2) ... on low..high.
bernstein_polynomial with_roots(double low, double high, const std::vector<double>& roots) {
  bernstein_polynomial product(low, high, 1.0);
  for (const double r : roots) {
    auto next = product.times_x();
    next += -r * product;
    product = next;
  }
  return product;
}

/// Chebyshev's polynomial of degree n on -1..1, between -1 and 1, which it takes n + 1 times.
bernstein_polynomial chebyshev(int n, double low, double high) {
  bernstein_polynomial before(low, high, 1.0);
  auto here = before.times_x();
  for (int k = 1; k < n; ++k) {
    auto after = 2.0 * here.times_x();
    after += -1.0 * before;
    before = here;
    here = after;
  }
  return here;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_margin_is_the_share_to_the_end_of_the_window) {
  const auto near = tolerance(4.0 * eps);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 1.5) == 0.25, near);
  BOOST_TEST(stability_margin(of_verlet, 1.0, 1.5) == 0.25, near);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 2.0) == 0.0);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 0.0) == 1.0);
  BOOST_TEST(stability_margin(of_verlet, 0.0, 3.0) == -0.5, near);
  BOOST_TEST(stability_margin(of_verlet, 2.5, 3.0) == -0.5, near);
}

// In a later window both ends count, the nearer one most.
BOOST_AUTO_TEST_CASE(a_gap_below_is_an_end_too) {
  const auto near = tolerance(8.0 * eps);
  BOOST_TEST(stability_margin(with_a_gap, 3.2, 3.3) == 1.0 - again / 3.2, near);
  BOOST_TEST(stability_margin(with_a_gap, 4.0, 4.05) == 1.0 - 4.05 / last, near);
  // From below the gap into the later window: unstable, by as much as it is beyond the first.
  BOOST_TEST(stability_margin(with_a_gap, 0.0, 3.5) == 1.0 - 3.5 / end, near);
  BOOST_TEST(stability_margin(with_a_gap, 2.9, 3.0) == 1.0 - 3.0 / end, near);
}

BOOST_AUTO_TEST_CASE(it_is_negative_where_unstable_and_nowhere_else) {
  for (int i = 0; i <= 500; ++i) {
    for (const double width : {0.0, 0.3, 1.0}) {
      const double low = 0.01 * i;
      const bool stable = is_stable(with_a_gap, low, low + width);
      BOOST_TEST((stability_margin(with_a_gap, low, low + width) >= 0.0) == stable, low << " " << width);
    }
  }
  const double nothing = -std::numeric_limits<double>::infinity();
  BOOST_TEST(stability_margin({}, 0.0, 1.0) == nothing);
  BOOST_TEST(stability_margin({{1.0, 2.0}}, 0.5, 0.6) == nothing);
  BOOST_TEST(stability_margin(of_verlet, 0.0, std::numeric_limits<double>::infinity()) == nothing);
}

BOOST_AUTO_TEST_CASE(stable_steps_are_those_of_all_bands) {
  const auto near = tolerance(4.0 * eps);
  const std::vector<frequency_band> apart{{0.0, 5.0}, {50.0, 51.0}};
  const auto steps = stable_steps(with_a_gap, apart);
  BOOST_REQUIRE(steps.size() == 2U);
  BOOST_TEST(steps[0].low == 0.0);
  BOOST_TEST(steps[0].high == end / 51.0, near);
  BOOST_TEST(steps[1].low == again / 50.0, near);
  BOOST_TEST(steps[1].high == last / 51.0, near);
  for (int i = 1; i < 1000; ++i) {
    const double h = 1e-4 * i;
    const bool claimed =
        std::any_of(steps.begin(), steps.end(), [h](const auto& s) { return s.low <= h && h <= s.high; });
    const bool stable = is_stable(with_a_gap, 0.0, 5.0 * h) && is_stable(with_a_gap, 50.0 * h, 51.0 * h);
    BOOST_TEST(claimed == stable, h);
  }
  // What has all frequencies up to the highest has none of the later window.
  BOOST_TEST(stable_steps(with_a_gap, {{0.0, 51.0}}).size() == 1U);
  // Nor what is too wide for it.
  BOOST_TEST(stable_steps(with_a_gap, {{30.0, 51.0}}).size() == 1U);
  BOOST_TEST(stable_steps({{1.0, 2.0}}, {{0.0, 1.0}}).empty());
  BOOST_TEST(stable_steps(of_verlet, {}).size() == 1U);
}

BOOST_AUTO_TEST_CASE(gaps_are_what_is_left_of_the_windows) {
  BOOST_TEST(gaps_below(with_a_gap, 2.5).empty());
  const auto some = gaps_below(with_a_gap, 3.0);
  BOOST_REQUIRE(some.size() == 1U);
  BOOST_TEST(some[0].low == end);
  BOOST_TEST(some[0].high == 3.0);
  const auto all = gaps_below(with_a_gap, 5.0);
  BOOST_REQUIRE(all.size() == 2U);
  BOOST_TEST(all[0].high == again);
  BOOST_TEST(all[1].low == last);
  BOOST_TEST(gaps_below({}, 1.0).size() == 1U);
}

// A step of phase t is n of phase t/n: cos t = +-1 at t = pi, ..., (n - 1) pi, and an Euler step of phase a
// has z = 2 sin(a/2). At an extremum trace/2 is flat, and z known to the square root of its rounding.
BOOST_AUTO_TEST_CASE(windows_touch_where_equal_steps_make_half_turns) {
  const auto near = tolerance(1e-6);
  for (const std::size_t n : {1U, 2U, 3U, 5U}) {
    const auto chart = chart_of_eulers(n);
    BOOST_REQUIRE(chart.touching.size() == n - 1);
    for (std::size_t k = 1; k < n; ++k) {
      const auto steps = static_cast<double>(n);
      const double expected = 2.0 * steps * std::sin(0.5 * std::numbers::pi * static_cast<double>(k) / steps);
      BOOST_TEST(chart.touching[k - 1] == expected, near);
    }
    BOOST_TEST(chart.windows.size() == 1U);
  }
  // The worst case for finding extrema.
  for (const std::size_t n : {8U, 9U, 12U, 16U, 20U, 32U, 64U}) {
    const auto windows = chart_of_eulers(n).windows;
    BOOST_TEST_CONTEXT(n << " steps") {
      BOOST_TEST(windows.size() == 1U);
      BOOST_TEST(std::abs(windows.back().high - 2.0 * static_cast<double>(n)) < 1e-6);
    }
  }
}

// Two half steps of Verlet touch at sqrt 8, and no other word of two stages; of three stages, that of BCSS.
BOOST_AUTO_TEST_CASE(a_gap_is_no_touch) {
  const auto two_stages = [](double b1, double beta1) {
    const auto c = nystrom::coefficients(std::array{b1, beta1});
    return chart_of("ABABA", {c.begin(), c.end()});
  };
  const auto halves = two_stages(0.5, 0.375);
  BOOST_REQUIRE(halves.touching.size() == 1U);
  BOOST_TEST(std::abs(halves.touching[0] - std::sqrt(8.0)) < 1e-7);
  BOOST_TEST(std::abs(halves.windows[0].high - 4.0) < 1e-7);
  BOOST_TEST(two_stages(0.5, 0.38).touching.empty());
  BOOST_TEST(two_stages(0.5, 0.4).windows.size() == 2U);
  const auto c = bcss3().coefficients();
  const auto of_bcss = chart_of("BABABAB", {c.begin(), c.end()});
  BOOST_REQUIRE(of_bcss.touching.size() == 1U);
  BOOST_TEST(of_bcss.touching[0] < of_bcss.windows[0].high);
  // A hundredth beside, and there is a gap.
  const double b = c[0] + 0.01;
  const auto beside = chart_of("BABABAB", {b, c[1], 0.5 - b, c[3], 0.5 - b, c[1], b});
  BOOST_TEST(beside.touching.empty());
  BOOST_TEST(beside.windows[0].high < of_bcss.touching[0]);
}

BOOST_AUTO_TEST_CASE(values_at_the_ends_of_all_halves_are_those_of_the_product) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    std::vector<double> roots;
    for (int k = 0; k < 6; ++k) roots.push_back(random.uniform(-1.0, 4.0));
    auto f = with_roots(0.5, 3.0, roots);
    for (int depth = 0; depth < 5; ++depth) {
      double expected = 1.0;
      for (const double r : roots) expected *= f.high() - r;
      // 6 factors of a size up to 4 each, 6 roundings of each, and halves that round once each.
      BOOST_TEST(std::abs(f.at_high() - expected) <= 40.0 * eps * std::pow(4.0, 6.0));
      BOOST_TEST(f.bounds().first <= f.at_low());
      BOOST_TEST(f.bounds().second >= f.at_high());
      auto [lower, upper] = f.halves();
      BOOST_TEST(lower.high() == upper.low());
      BOOST_TEST(lower.at_high() == upper.at_low());
      f = depth % 2 == 0 ? lower : upper;
    }
  }
}

BOOST_AUTO_TEST_CASE(a_strip_that_is_only_touched_is_not_left) {
  for (const int n : {2, 3, 6, 9, 12}) {
    // Twice the previous at each degree: rounding grows like that of 2^n terms.
    const double rounding = 4.0 * std::pow(2.0, n) * eps;
    BOOST_TEST(!where_larger(chebyshev(n, -1.0, 1.0), 1.0 + rounding).has_value());
    BOOST_TEST(where_larger(chebyshev(n, -1.0, 1.0), 1.0 - 1e-6).has_value());
    BOOST_TEST(where_larger(chebyshev(n, -1.0, 1.001), 1.0 + rounding).value_or(0.0) > 1.0);
  }
}

// 1 + 1e-8 at x = 1/3, and below 1 but for 2e-4 around it.
BOOST_AUTO_TEST_CASE(the_narrowest_hump_is_found) {
  auto hump = -1.0 * with_roots(0.0, 1.0, {1.0 / 3.0, 1.0 / 3.0});
  hump += bernstein_polynomial(0.0, 1.0, 1.0 + 1e-8);
  const auto x = where_larger(hump, 1.0);
  BOOST_REQUIRE(x.has_value());
  BOOST_TEST(std::abs(*x - 1.0 / 3.0) <= 1e-4);
  BOOST_TEST(!where_larger(hump, 1.0 + 1e-8 + eps).has_value());
}

// Chebyshev's polynomial of degree n turns n - 1 times, and its Bernstein coefficients alternate.
BOOST_AUTO_TEST_CASE(turns_are_counted) {
  for (const int n : {2, 3, 6, 9, 12}) {
    BOOST_TEST(chebyshev(n, -1.0, 1.0).turns(0.0) == n - 1);
    BOOST_TEST(chebyshev(n, 1.0, 2.0).turns(0.0) == 0);
  }
  auto rounded = bernstein_polynomial(0.0, 1.0, 1.0);
  rounded += eps * chebyshev(6, 0.0, 1.0);
  BOOST_TEST(rounded.turns(1000.0 * eps) == 0);
  // Two roots of the derivative, 1/4 and 3/4, in one interval; one in each half.
  auto wave = 2.0 / 3.0 * with_roots(0.0, 1.0, {0.0, 0.0, 0.0});
  wave += -1.0 * with_roots(0.0, 1.0, {0.0, 0.0});
  wave += 0.375 * with_roots(0.0, 1.0, {0.0});
  BOOST_TEST(wave.turns(0.0) == 2);
  BOOST_TEST(wave.halves().first.turns(0.0) == 1);
  BOOST_TEST(wave.halves().second.turns(0.0) == 1);
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_within_nothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(where_larger(bernstein_polynomial(0.0, 1.0, nan), 1e300).has_value());
  BOOST_TEST(where_larger(with_roots(0.0, 1.0, {0.1, nan, 0.2}), 1e300).has_value());
}
