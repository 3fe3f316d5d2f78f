// SPDX-License-Identifier: BSL-1.0
// What takes long motion or a large system to be seen. Tier 1 has short ones of the same commands in
// tests/programs/cases/comparison.txt and stability.txt.
#include <boost/test/unit_test.hpp>

#include "../../support/program.hpp"

using namespace nysalt::test;

// Chaos of rate 0.2 or so makes of a millionth what it likes in ln(10^6)/0.2 = 70 or more.
BOOST_AUTO_TEST_CASE(rows_beyond_what_can_be_predicted_are_marked) {
  const auto longer =
      document("compare --methods srkn6b,verlet --steps 0.01 --trajectories 16 --horizon 400");
  const double until = longer["references"][0]["predictable_until"];
  BOOST_TEST(until > 50.0);
  BOOST_TEST(until < 400.0);
  for (const auto& row : longer["rows"]) BOOST_TEST(row["marks"].dump().find("horizon") != std::string::npos);
  BOOST_TEST(longer["rankings"][0]["front_by_evaluations"].empty());
}

BOOST_AUTO_TEST_CASE(what_is_too_large_to_be_looked_at_is_told_all_the_same) {
  const auto large = document("stability --method verlet --step 0.01 --system fpu --pairs 100000");
  BOOST_TEST(large["along_starts"].is_null());
  BOOST_TEST(large["frequency_source"] == "declared");
}
