// SPDX-License-Identifier: BSL-1.0
// What sample does where nothing is asked for, and that the document says so.
#include <boost/test/unit_test.hpp>

#include <numbers>
#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

BOOST_AUTO_TEST_CASE(with_masses_a_trajectory_is_a_quarter_of_a_period_long) {
  const std::string line = "sample --system pendulum --draws 5 --burn-in 100 --json ";
  const json usual = document(line + "--diagonal-masses");
  BOOST_TEST(usual["length"] == 0.5 * std::numbers::pi);  // the frequency is 1 in units of the masses
  BOOST_TEST(usual["chains"] == 4);
  BOOST_TEST(usual["draws"] == 5);
  BOOST_TEST(usual["burn_in"] == 100);
  BOOST_TEST(usual["warnings"] == json::array());
  BOOST_TEST(document(line + "--length 2 --chains 3")["chains"] == 3);
}
