// SPDX-License-Identifier: BSL-1.0
// Bernstein's coefficients enclose a polynomial, and tell where it leaves a strip.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/bernstein.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

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
