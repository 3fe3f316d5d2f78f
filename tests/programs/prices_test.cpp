// SPDX-License-Identifier: BSL-1.0
// Comparisons at declared prices of the parts of a force.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/program.hpp"
#include "../support/rounding.hpp"

using namespace nysalt::test;

namespace {

const std::string of_parts =
    "compare --system " NYSALT_SOURCE_DIR
    "/examples/plugins/bonds_and_charges.hpp --methods "
    "verlet,word:1A0A0A1,word:kA0A0Ak,word:A1A0A1A --horizon 1 --trajectories 8 --metric state ";

nlohmann::ordered_json compared(const scratch& folder, const std::string& options) {
  const auto done = run(folder, of_parts + options + "--json");
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  return json_of(done);
}

}  // namespace

// In the loop the last letter is merged with the first: two bonds and one charge of 1A0A0A1, two bonds and
// both of kA0A0Ak, two charges and one bond of A1A0A1A, whose drifts merge.
BOOST_AUTO_TEST_CASE(equal_cost_counts_each_kick_at_its_price) {
  const scratch folder("prices");
  const auto plain = compared(folder, "--steps 0.01 --equal-cost ");
  const auto priced = compared(folder, "--steps 0.01 --equal-cost --prices 1,9 ");
  const double without[]{1.0, 3.0, 4.0, 3.0};
  const double with[]{1.0, 1.1, 1.2, 1.9};
  for (std::size_t k = 0; k < 4; ++k) {
    BOOST_TEST_CONTEXT(priced["rows"][k]["method"]) {
      const auto& row = priced["rows"][k];
      BOOST_TEST(plain["rows"][k]["step_size"].get<double>() == 0.01 * without[k],
                 boost::test_tools::tolerance(4 * eps));
      BOOST_TEST(row["step_size"].get<double>() == 0.01 * with[k], boost::test_tools::tolerance(8 * eps));
      // Beside the steps there is one more evaluation, to open the run, at most, in 47 steps or more.
      BOOST_TEST(row["evaluations_per_time"].get<double>() == 100.0, boost::test_tools::tolerance(0.06));
    }
  }
  BOOST_TEST(priced["prices"] == nlohmann::ordered_json({1.0, 9.0}));
  BOOST_TEST(!plain.contains("prices"));
  // The unit of the prices does not count.
  const auto scaled = compared(folder, "--steps 0.01 --equal-cost --prices 0.5,4.5 ");
  BOOST_TEST(scaled["rows"][1]["error"] == priced["rows"][1]["error"]);
}

BOOST_AUTO_TEST_CASE(the_table_says_what_a_kick_costs) {
  const scratch folder("prices_text");
  const auto done = run(folder, of_parts + "--steps 0.01 --prices 1,9 ");
  BOOST_TEST(done.out.find("a kick costs 0.1 with part 0, 0.9 with part 1") != std::string::npos, done.out);
}

BOOST_AUTO_TEST_CASE(prices_that_are_none_are_refused) {
  const scratch folder("prices_refused");
  const auto refused = [&](const std::string& line, const std::string& why) {
    const auto done = run(folder, line);
    BOOST_TEST(done.code == 2, line);
    BOOST_TEST(done.err.find(why) != std::string::npos, done.err);
  };
  refused(of_parts + "--steps 0.01 --prices 1", "--prices must be 2 numbers");
  refused(of_parts + "--steps 0.01 --prices 1,2,3", "--prices must be 2 numbers");
  refused(of_parts + "--steps 0.01 --prices 1,-2", "--prices must be finite numbers >= 0, got -2");
  refused(of_parts + "--steps 0.01 --prices 1,inf", "--prices must be a finite number, got 'inf'");
  refused(of_parts + "--steps 0.01 --prices 0,0", "--prices must have a positive and finite sum, got 0");
  refused(of_parts + "--steps 0.01 --prices 1e308,1e308",
          "--prices must have a positive and finite sum, got inf");
  refused("compare --system " NYSALT_SOURCE_DIR
          "/examples/plugins/cubic_well.hpp --methods verlet --steps 0.01 --prices 1,2",
          "--prices must be for a system with letters that kick with parts");
  refused("compare --system fpu --methods verlet --steps 0.01 --prices 1,2",
          "--prices must be for a system with letters that kick with parts");
}
