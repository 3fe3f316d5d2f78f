// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/pareto_front.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/draws.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using indices = std::vector<std::size_t>;
indices front(const std::vector<cost_and_error>& all) { return pareto_front(all); }

}  // namespace

BOOST_AUTO_TEST_CASE(who_costs_more_must_err_less) {
  BOOST_TEST(front({{3.0, 1.0}, {1.0, 3.0}, {2.0, 2.0}}) == (indices{1, 2, 0}));
  BOOST_TEST(front({{3.0, 1.0}, {1.0, 3.0}, {2.0, 4.0}}) == (indices{1, 0}));
  BOOST_TEST(front({{1.0, 1.0}, {2.0, 2.0}}) == (indices{0}));
  BOOST_TEST(front({}).empty());
}

BOOST_AUTO_TEST_CASE(of_equals_the_first_is_kept) {
  BOOST_TEST(front({{1.0, 2.0}, {1.0, 2.0}}) == (indices{0}));
  BOOST_TEST(front({{1.0, 3.0}, {1.0, 2.0}}) == (indices{1}));  // as dear, and better
  BOOST_TEST(front({{2.0, 2.0}, {1.0, 2.0}}) == (indices{1}));  // as good, and cheaper
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_never_there) {
  BOOST_TEST(front({{1.0, NAN}, {NAN, 1.0}, {0.5, INFINITY}, {-INFINITY, 1.0}, {2.0, 2.0}}) == (indices{4}));
  BOOST_TEST(front({{1.0, NAN}}).empty());
}

// The definition, pair by pair.
BOOST_AUTO_TEST_CASE(nobody_on_the_front_is_beaten) {
  draws random;
  std::vector<cost_and_error> all(200);
  for (auto& [cost, error] : all) {
    cost = std::round(random.uniform(0.0, 30.0));  // many ties
    error = std::round(random.uniform(0.0, 30.0));
  }
  indices expected;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool beaten = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool as_good = all[k].cost <= all[i].cost && all[k].error <= all[i].error;
      const bool equal = all[k].cost == all[i].cost && all[k].error == all[i].error;
      beaten = beaten || (as_good && (!equal || k < i));
    }
    if (!beaten) expected.push_back(i);
  }
  auto found = front(all);
  BOOST_TEST(found.size() > 2U);
  std::ranges::sort(found);
  BOOST_TEST(found == expected);
}
