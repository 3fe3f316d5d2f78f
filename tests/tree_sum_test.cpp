// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/tree_sum.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace nysalt;

BOOST_AUTO_TEST_CASE(it_adds_every_term_once) {
  for (std::size_t n = 1; n < 200; ++n) {
    std::vector<double> terms(n);
    std::iota(terms.begin(), terms.end(), 1.0);
    BOOST_TEST(tree_sum(terms) == 0.5 * static_cast<double>(n * (n + 1)));  // integers: exact
  }
  BOOST_CHECK_THROW(tree_sum(std::vector<double>{}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(the_order_is_leaves_of_16_then_a_tree) {
  std::vector<double> terms(3 * 16 + 5);
  for (std::size_t i = 0; i < terms.size(); ++i)
    terms[i] = std::sin(static_cast<double>(i)) * 1e3 + 1.0 / 3.0;
  const auto leaf = [&](std::size_t first, std::size_t last) {
    double sum = terms[first];
    for (std::size_t i = first + 1; i < last; ++i) sum += terms[i];
    return sum;
  };
  const double expected = (leaf(0, 16) + leaf(16, 32)) + (leaf(32, 48) + leaf(48, 53));
  BOOST_TEST(tree_sum(terms) == expected);
  // Another order gives other bits: the test above can tell.
  BOOST_TEST(std::accumulate(terms.begin(), terms.end(), 0.0) != expected);
}
