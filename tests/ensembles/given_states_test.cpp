// SPDX-License-Identifier: BSL-1.0
// Ensembles around states that the user gives.
#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinite = std::numeric_limits<double>::infinity();
using point = phase_point<double, 2>;
const point centre{{1.0, 2.0}, {3.0, 4.0}};
using wrong = std::invalid_argument;
}  // namespace

BOOST_AUTO_TEST_CASE(listed_states_come_in_their_order_and_no_further) {
  const point other{{5.0, 6.0}, {7.0, 8.0}};
  const listed<2> two({centre, other});
  BOOST_TEST(same_bits(two(1, 0), centre));
  BOOST_TEST(same_bits(two(2, 0), centre));  // the seed is of no account
  BOOST_TEST(same_bits(two(1, 1), other));
  BOOST_TEST(refuses<std::out_of_range>([&] { two(1, 2); }, {"listed", "number 3 of 2"}));
  BOOST_TEST(refuses<std::out_of_range>([] { listed<2>({})(1, 0); }, {"number 1 of 0"}));
  BOOST_TEST(two.description() == "listed(2 states)");
}

BOOST_AUTO_TEST_CASE(normal_around_has_the_given_mean_and_deviations) {
  const normal_around<2> cloud(centre, 0.5, 0.1);
  const double allowed = standard_errors(false_alarms / 10);  // two coordinates, five comparisons
  for (int i = 0; i < 2; ++i) {
    std::vector<double> q;
    std::vector<double> p;
    for (std::uint64_t n = 0; n < 20'000; ++n) {
      const point x = cloud(seed(3), n);
      q.push_back(x.q[i]);
      p.push_back(x.p[i]);
    }
    BOOST_TEST(mean_off(q, centre.q[i], 0.5) <= allowed);
    BOOST_TEST(mean_off(p, centre.p[i], 0.1) <= allowed);
    BOOST_TEST(deviation_off(q, 0.5) <= allowed);
    BOOST_TEST(deviation_off(p, 0.1) <= allowed);
    BOOST_TEST(deviation_off(q, 0.1) > allowed);
    BOOST_TEST(std::abs(correlation(q, p)) * std::sqrt(20'000.0) <= allowed);
  }
  BOOST_TEST(same_bits(cloud(3, 9), cloud(3, 9)));
  BOOST_TEST(!same_bits(cloud(4, 9), cloud(3, 9)));
  BOOST_TEST(!same_bits(cloud(4, 9), cloud(3, 10)));
}

BOOST_AUTO_TEST_CASE(without_deviation_it_is_the_centre) {
  BOOST_TEST(same_bits(normal_around<2>(centre, 0.0, 0.0)(1, 1), centre));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  for (const double bad : {-0.1, not_a_number, infinite}) {
    BOOST_TEST(
        refuses<wrong>([&] { normal_around<2>(centre, bad, 0.1); }, {"normal_around", "deviations must be"}));
    BOOST_TEST(
        refuses<wrong>([&] { normal_around<2>(centre, 0.1, bad); }, {"normal_around", "deviations must be"}));
  }
  const point nowhere{{not_a_number, 0.0}, {0.0, 0.0}};
  BOOST_TEST(refuses<wrong>([&] { normal_around<2>(nowhere, 0.1, 0.1); },
                            {"normal_around", "centre must be finite"}));
}
