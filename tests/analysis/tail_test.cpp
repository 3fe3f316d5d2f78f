// SPDX-License-Identifier: BSL-1.0
// A sample whose largest numbers decide is told from one that they do not.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/analysis/tail.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using numbers = std::vector<double>;

/// Samples of 1/u^(1/index), u uniform on (0, 1): moments from the order `index` on do not exist.
numbers pareto(draws& random, double index, int count) {
  numbers result;
  for (int i = 0; i < count; ++i) result.push_back(std::pow(random.uniform(0.0, 1.0), -1.0 / index));
  return result;
}
}  // namespace

// Of 0, 0, 0, 4: mean 1, central moments 3 and 6; (sum x)^2/sum x^2 = 1.
BOOST_AUTO_TEST_CASE(a_tail_is_what_its_moments_say) {
  const auto near = boost::test_tools::tolerance(32 * eps);
  const tail found = tail_of(numbers{0.0, NAN, 0.0, 4.0, 0.0});
  BOOST_TEST(found.count == 4.0);
  BOOST_TEST(found.skewness == 6.0 / std::pow(3.0, 1.5), near);
  BOOST_TEST(found.deciding == 1.0, near);
  BOOST_TEST(found.enough() == 25.0 * 36.0 / 27.0, near);
  BOOST_TEST(found.is_heavy());
  BOOST_TEST(std::abs(tail_of(numbers{1.0, 2.0, 3.0}).skewness) < 8 * eps);
  BOOST_TEST(tail_of(numbers{2.0, 2.0, 2.0}).deciding == 3.0);
}

BOOST_AUTO_TEST_CASE(units_do_not_matter) {
  draws random;
  numbers small = pareto(random, 3.0, 100);
  const tail unscaled = tail_of(small);
  for (double& x : small) x *= 0x1p-900;
  BOOST_TEST(tail_of(small).skewness == unscaled.skewness);  // a power of two: to the bit
  BOOST_TEST(tail_of(small).deciding == unscaled.deciding);
}

BOOST_AUTO_TEST_CASE(what_is_equal_or_nothing_has_no_tail) {
  BOOST_TEST(!tail_of(numbers{}).is_heavy());
  BOOST_TEST(!tail_of(numbers{NAN}).is_heavy());
  BOOST_TEST(!tail_of(numbers{0.0, 0.0}).is_heavy());
  BOOST_TEST(!tail_of(numbers{0.1, std::nextafter(0.1, 1.0), 0.1, 0.1}).is_heavy());
  BOOST_TEST(!tail_of(numbers(100, 0.1)).is_heavy());
}

// Without a variance the skewness of a sample grows like the root of its size, and no size is enough; that of
// a uniform law is 0, with a standard error of sqrt(6/400) = .12: .8 is beyond six of them.
BOOST_AUTO_TEST_CASE(a_law_without_variance_is_heavy_at_any_size) {
  draws random(seed(1));
  for (const int count : {100, 400, 6400}) {
    int heavy = 0;
    int light = 0;
    for (int k = 0; k < 20; ++k) {
      heavy += tail_of(pareto(random, 1.2, count)).is_heavy();
      numbers uniform;
      for (int i = 0; i < count; ++i) uniform.push_back(random.uniform(0.0, 1.0));
      light += tail_of(uniform).is_heavy();
    }
    BOOST_TEST_CONTEXT(count << " numbers: " << heavy) {
      BOOST_TEST(20 - heavy <= most_of(20, 0.01, false_alarms / 3));  // each is with a probability above .99
      BOOST_TEST(light == 0);
    }
  }
}

// Exponential numbers have skewness 2: a hundred are just enough, and more are.
BOOST_AUTO_TEST_CASE(a_light_tail_needs_a_larger_sample) {
  draws random(seed(1));
  const auto exponential = [&](int count) {
    numbers result;
    for (int i = 0; i < count; ++i) result.push_back(-std::log(random.uniform(0.0, 1.0)));
    return tail_of(result);
  };
  int too_small = 0;
  for (int k = 0; k < 100; ++k) too_small += exponential(20).enough() > 1.0;
  BOOST_TEST(too_small > 50);
  BOOST_TEST(!exponential(10000).is_heavy());
  const double skewness = exponential(40000).skewness;
  BOOST_TEST(std::abs(skewness - 2.0) < 0.5);
}
