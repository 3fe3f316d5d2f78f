// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/in_digits.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>

using namespace nysalt;

BOOST_AUTO_TEST_CASE(numbers_are_cut_to_their_first_digits) {
  BOOST_TEST(in_digits(0.125, 2) == "0.12");
  BOOST_TEST(in_digits(2.0 / 3.0, 6) == "0.666667");
  BOOST_TEST(in_digits(1234567.0, 6) == "1.23457e+06");
  BOOST_TEST(in_digits(100.0, 4) == "100");
  BOOST_TEST(in_digits(0.005, 12) == "0.005");
  BOOST_TEST(in_digits(-std::numeric_limits<double>::infinity(), 6) == "-inf");
}
