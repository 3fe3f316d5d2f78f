// SPDX-License-Identifier: BSL-1.0
// Starts beyond the energies that were learned on are told from those that are outside by chance.
#include <boost/test/unit_test.hpp>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/learning/energies_outside.hpp"

using namespace nysalt;

namespace {

/// Energies of `degrees` squares of normal numbers, as those of Gaussian starts are.
class gaussian_energies {
 public:
  gaussian_energies(double degrees, double scale) : law_(0.5 * degrees, scale) {}
  std::vector<double> operator()(std::size_t count) {
    std::vector<double> result;
    for (std::size_t n = 0; n < count; ++n) result.push_back(law_(random_));
    return result;
  }

 private:
  std::mt19937_64 random_{test::seed(7)};
  std::gamma_distribution<double> law_;
};

energy_range range_of(const std::vector<double>& energies) {
  energy_range result;
  for (const double x : energies) result.include(x);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_range_holds_what_it_has_seen_and_a_millionth_more) {
  energy_range seen;
  BOOST_TEST(!seen.contains(0.0));
  seen.include(-2.0);
  seen.include(1.0);
  for (const double inside : {-2.0, -2.0000015, 0.0, 1.0, 1.0000015}) BOOST_TEST(seen.contains(inside));
  for (const double outside : {-2.00001, 1.00001, 5.0, std::numeric_limits<double>::quiet_NaN()}) {
    BOOST_TEST(!seen.contains(outside));
  }
  BOOST_TEST(seen.distance(3.0) == 2.0);
  BOOST_TEST(seen.distance(-5.0) == 3.0);
}

// The energies of M trajectories leave 1 - p of the law inside, p of the law beta(2, M - 1); then the number
// outside is binomial.
BOOST_AUTO_TEST_CASE(the_probability_is_that_of_the_beta_binomial_law) {
  for (const std::size_t m : {2U, 10U, 100U}) {
    for (const std::size_t n : {1U, 7U, 400U}) {
      for (const std::size_t outside : {1U, 2U, 5U}) {
        if (outside > n) continue;
        const boost::math::beta_distribution<double> left(2.0, static_cast<double>(m) - 1.0);
        const double fewer = static_cast<double>(n - outside + 1);
        const auto at_least = [&](double p) {  // of n, binomial
          return pdf(left, p) * boost::math::ibeta(static_cast<double>(outside), fewer, p);
        };
        const double expected =
            boost::math::quadrature::gauss_kronrod<double, 61>::integrate(at_least, 0.0, 1.0, 15, 1e-12);
        const energies_outside counts{
            .seen = {0.0, 1.0}, .trajectories = m, .examined = n, .outside = outside};
        BOOST_TEST_CONTEXT(outside << " of " << n << " beyond " << m) {
          BOOST_TEST(counts.probability() == expected, boost::test_tools::tolerance(1e-9));
        }
      }
    }
  }
  const energies_outside one{.seen = {0.0, 1.0}, .trajectories = 100, .examined = 1, .outside = 1};
  BOOST_TEST(one.probability() == 2.0 / 101.0, boost::test_tools::tolerance(1e-12));
  const energies_outside blind{.seen = {0.0, 0.0}, .trajectories = 1, .examined = 50, .outside = 50};
  BOOST_TEST(blind.probability() == 1.0);  // one trajectory tells no range
  BOOST_TEST(!blind.is_serious());
}

BOOST_AUTO_TEST_CASE(starts_of_the_same_law_are_hardly_ever_serious) {
  for (const double degrees : {2.0, 12.0}) {  // 2: an exponential law, the widest that is allowed for
    for (const std::size_t n : {1U, 10U, 1000U}) {
      gaussian_energies draw(degrees, 3.0);
      constexpr int trials = 2000;
      int serious = 0;
      int outside = 0;
      for (int k = 0; k < trials; ++k) {
        const auto seen = range_of(draw(100));
        const auto found = count_outside(seen, 100, draw(n));
        serious += found.is_serious();
        outside += found.outside > 0;
      }
      BOOST_TEST_CONTEXT(degrees << " degrees, " << n << " starts: " << serious << " serious, " << outside
                                 << " outside of " << trials) {
        // Two tests of one in a thousand each: 4 in the mean; of six cases.
        BOOST_TEST(serious <= test::most_of(trials, 0.002, test::false_alarms / 6));
        if (n == 1000) BOOST_TEST(outside > trials / 2);  // a warning for one would always come
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(starts_of_other_energies_are_serious) {
  // Of 60 degrees, 100 energies are in [8, 75] but for a probability of 5e-7, as their distribution is
  // Gamma(30): all of the colder ones are then below 0.05 * 75, and 0.98 of the hotter ones above 75. Of 12
  // degrees the least of 100 is so near to 0, one time in 200, that everything below is gentle.
  gaussian_energies draw(60.0, 1.0);
  gaussian_energies hotter(60.0, 4.0);
  gaussian_energies colder(60.0, 0.05);
  const auto seen = range_of(draw(100));
  for (auto* other : {&hotter, &colder}) {
    for (const std::size_t n : {40U, 1000U}) {  // of ten at most three are outside once in 300 times
      const auto found = count_outside(seen, 100, (*other)(n));
      BOOST_TEST_CONTEXT(found.report()) BOOST_TEST(found.is_serious());
    }
  }
  // A single start, and one among a thousand, if they are far enough.
  const double width = seen.high - seen.low;
  BOOST_TEST(!count_outside(seen, 100, std::vector{seen.high + 0.4 * width}).is_serious());
  BOOST_TEST(count_outside(seen, 100, std::vector{seen.high + 0.6 * width}).is_serious());
  std::vector<double> many(1000, 0.5 * (seen.low + seen.high));
  many[17] = seen.high + 2.0 * width;
  BOOST_TEST(!count_outside(seen, 100, many).is_serious());
  many[17] = seen.high + 3.0 * width;
  BOOST_TEST(count_outside(seen, 100, many).is_serious());
  // Where all had one energy, another is far.
  BOOST_TEST(!count_outside({-0.5, -0.5}, 100, std::vector(20, -0.5 * (1.0 + 1e-9))).is_serious());
  BOOST_TEST(count_outside({-0.5, -0.5}, 100, std::vector{-0.4}).is_serious());
}

BOOST_AUTO_TEST_CASE(the_report_says_how_many_and_what_was_seen) {
  const auto found = count_outside({1.0, 2.0}, 100, std::vector{0.5, 1.5, 7.0});
  BOOST_TEST(found.outside == 2U);
  BOOST_TEST(found.examined == 3U);
  BOOST_TEST(found.farthest == 5.0);
  for (const char* words : {"2 of 3 starts", "1 to 2", "0.5 to 7"}) {
    BOOST_TEST(found.report().find(words) != std::string::npos, found.report());
  }
}
