// SPDX-License-Identifier: BSL-1.0
// Each letter O has its own part of the step.
#include "nysalt/noise_intervals.hpp"

#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/methods/baoab.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using parts = std::vector<noise_interval>;

template <class M>
noise_intervals of_method() {
  return intervals_of_noise(M::word::letters(), M::coefficients());
}
noise_intervals of_letters(const std::vector<double>& coefficients) {
  return intervals_of_noise(std::string(coefficients.size(), 'O'), coefficients);
}
bool refused(const std::vector<double>& coefficients, auto... words) {
  return refuses<std::invalid_argument>([&] { of_letters(coefficients); }, {words...});
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_letters_share_the_step_in_their_order) {
  BOOST_TEST(of_method<baoab>().parts == 1);
  BOOST_TEST((of_method<baoab>().of_letters == parts{{0, 1}}));
  BOOST_TEST(of_method<obabo>().parts == 2);
  BOOST_TEST((of_method<obabo>().of_letters == parts{{0, 1}, {1, 2}}));
  BOOST_TEST((of_method<baoab_2x>().of_letters == parts{{0, 1}, {1, 2}}));
  const auto uneven = of_letters({1.0 / 3.0, 0.5, 1.0 / 6.0});
  BOOST_TEST(uneven.parts == 6);
  BOOST_TEST((uneven.of_letters == parts{{0, 2}, {2, 5}, {5, 6}}));
}

BOOST_AUTO_TEST_CASE(without_a_letter_there_are_no_parts) {
  const auto none = intervals_of_noise("BAB", std::vector<double>{0.5, 1.0, 0.5});
  BOOST_TEST(none.parts == 0);
  BOOST_TEST(none.of_letters.empty());
}

BOOST_AUTO_TEST_CASE(the_same_in_more_parts) {
  const auto finer = of_method<obabo>().in_parts(6);
  BOOST_TEST(finer.parts == 6);
  BOOST_TEST((finer.of_letters == parts{{0, 3}, {3, 6}}));
}

BOOST_AUTO_TEST_CASE(coefficients_as_they_are_typed_will_do) {
  BOOST_TEST(of_letters({0.3333333333, 0.3333333333, 0.3333333334}).parts == 3);
  BOOST_TEST(refused({0.33333, 0.33333, 0.33334}, "equal parts"));
}

BOOST_AUTO_TEST_CASE(what_is_not_a_path_is_refused) {
  BOOST_TEST(refused({0.5, 0.4}, "OO", "cover 0.9", "and not one"));
  BOOST_TEST(refused({NAN}, "and not one"));
  BOOST_TEST(refused({0.1234567, 1.0 - 0.1234567}, "equal parts", "60"));
  BOOST_TEST(of_letters({1.0 / 60.0, 59.0 / 60.0}).parts == 60);
  BOOST_TEST(refused({1.0 / 61.0, 60.0 / 61.0}, "60"));
  BOOST_TEST(refused({1.5, -0.5}, "back in time"));  // they sum to one, but a path has its noise once
}
