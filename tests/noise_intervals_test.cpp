// SPDX-License-Identifier: BSL-1.0
// Letters O share a step in their order, each by its coefficient.
#include "nysalt/detail/noise_intervals.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using intervals = std::vector<noise_interval>;

template <Method M>
noise_intervals of(const M& method) {
  return intervals_of_noise(typename M::word{}, method.coefficients());
}
/// A word of letters O alone.
noise_intervals of_letters(const std::vector<double>& coefficients) {
  return intervals_of_noise(std::string(coefficients.size(), 'O'), coefficients);
}
bool equals(const noise_intervals& found, int parts, const intervals& expected) {
  return found.parts == parts && found.of_letters == expected;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_letter_covers_the_step_and_two_halves_share_it) {
  BOOST_TEST(equals(of(baoab()), 1, {{0, 1}}));
  BOOST_TEST(equals(of(aboba()), 1, {{0, 1}}));
  BOOST_TEST(equals(of(obabo()), 2, {{0, 1}, {1, 2}}));
  BOOST_TEST(equals(of(baoab_2x()), 2, {{0, 1}, {1, 2}}));
  BOOST_TEST(equals(of(verlet()), 0, {}));
  BOOST_TEST(!equals(of(obabo()), 2, {{1, 2}, {0, 1}}));
}

BOOST_AUTO_TEST_CASE(placements_need_one_part_or_two) {
  const mclachlan2 plain;
  BOOST_TEST(equals(of(thermostat<placement::end>(plain)), 1, {{0, 1}}));
  BOOST_TEST(equals(of(thermostat<placement::middle>(plain)), 1, {{0, 1}}));
  BOOST_TEST(equals(of(thermostat<placement::symmetric>(plain)), 2, {{0, 1}, {1, 2}}));
  using family = thermostatted_family<nystrom, placement::symmetric>;
  const auto intervals = intervals_of_noise(family::word{}, family::coefficients(family::start()));
  BOOST_TEST(equals(intervals, 2, {{0, 1}, {1, 2}}));
}

BOOST_AUTO_TEST_CASE(parts_are_as_few_as_cut_no_letter) {
  BOOST_TEST(equals(of_letters({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}), 3, {{0, 1}, {1, 2}, {2, 3}}));
  BOOST_TEST(equals(of_letters({0.3333333333, 0.3333333333, 0.3333333334}), 3, {{0, 1}, {1, 2}, {2, 3}}));
  BOOST_TEST(equals(of_letters({0.25, 0.5, 0.25}), 4, {{0, 1}, {1, 3}, {3, 4}}));
  BOOST_TEST(equals(of_letters({0.5, 1.0 / 3.0, 1.0 / 6.0}), 6, {{0, 3}, {3, 5}, {5, 6}}));
  BOOST_TEST(equals(of_letters({59.0 / 60.0, 1.0 / 60.0}), 60, {{0, 59}, {59, 60}}));
  BOOST_TEST(equals(of_letters({0.1, 0.9}), 10, {{0, 1}, {1, 10}}));  // ten times .1 is 1 to rounding
  BOOST_TEST(equals(of_letters({0.0, 1.0}), 1, {{0, 0}, {0, 1}}));    // one that does nothing
}

BOOST_AUTO_TEST_CASE(the_same_in_more_parts) {
  BOOST_TEST(equals(of(obabo()).in_parts(6), 6, {{0, 3}, {3, 6}}));
  BOOST_TEST(equals(of(obabo()).in_parts(2), 2, {{0, 1}, {1, 2}}));
  BOOST_TEST(equals(of(verlet()).in_parts(6), 6, {}));
}

BOOST_AUTO_TEST_CASE(what_covers_no_step_is_refused) {
  const auto refused = [](const std::vector<double>& c, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { of_letters(c); }, words);
  };
  BOOST_TEST(refused({0.5}, {"letters O of O", "cover one step", "got 0.5"}));
  BOOST_TEST(refused({0.5, 0.6}, {"OO", "cover one step", "got 1.1"}));
  BOOST_TEST(refused({0.5, 0.5 + 2e-9}, {"got 1.000000002"}));
  BOOST_TEST(!refused({0.5, 0.5 + 0.5e-9}, {}));  // as rounded to ten digits
  BOOST_TEST(refused({std::numeric_limits<double>::quiet_NaN()}, {"got nan"}));
  BOOST_TEST(refused({0.2928932188, 0.7071067812}, {"equal parts", "60 at most"}));
  BOOST_TEST(refused({60.0 / 61.0, 1.0 / 61.0}, {"equal parts", "60 at most"}));
}

BOOST_AUTO_TEST_CASE(a_letter_that_goes_back_in_time_is_refused) {
  BOOST_TEST(refuses<wrong>([] { of_letters({1.5, -0.5}); }, {"forward in time", "-0.5"}));
  BOOST_TEST(refuses<wrong>([] { of_letters({-0.5, 1.5}); }, {"forward in time", "-0.5"}));
}
