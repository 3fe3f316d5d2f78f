// SPDX-License-Identifier: BSL-1.0
// Who reads of a failure with random parameters reads the seed.
#include "draws.hpp"

#include <string>

using nysalt::test::draws;

namespace {

/// What a failure would print beside its own words.
bool failures_tell_the_seed() {
  auto frames = boost::unit_test::framework::get_context();
  for (auto frame = frames.next(); !frame.is_empty(); frame = frames.next()) {
    const std::string text(frame.begin(), frame.end());
    if (text.find("seed " + std::to_string(draws::seed)) != std::string::npos) return true;
  }
  return false;
}

double drawn() { return draws().uniform(-1.0, 1.0); }

}  // namespace

BOOST_AUTO_TEST_CASE(a_failure_after_a_draw_tells_the_seed) {
  BOOST_TEST(!failures_tell_the_seed());
  BOOST_TEST(std::abs(drawn()) <= 1.0);
  BOOST_TEST(failures_tell_the_seed());
}

BOOST_AUTO_TEST_CASE(each_test_case_tells_it_anew) {
  BOOST_TEST(!failures_tell_the_seed());
  for (int n = 0; n < 2; ++n) drawn();
  BOOST_TEST(failures_tell_the_seed());
}
