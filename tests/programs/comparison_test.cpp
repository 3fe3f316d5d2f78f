// SPDX-License-Identifier: BSL-1.0
// What the rows of a comparison are worth.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../support/program.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

BOOST_AUTO_TEST_CASE(comparison) { run_table("comparison"); }

// Fronts and costs are those of the rows beside them.
BOOST_AUTO_TEST_CASE(rankings_follow_from_the_rows) {
  const auto all = document(
      "compare --methods verlet,mclachlan2,srkn6b,learned:nystrom --steps 0.0025,0.005,0.01,0.02 "
      "--equal-cost "
      "--trajectories 20 --learn-trajectories 8 --learn-effort quick --metric state --horizon 1.2 --levels "
      "0.1,1e-9,100");
  const auto& ranking = all["rankings"][0];
  const std::string value = ranking["ranked_by"] == "median" ? "median" : "error";
  const auto beats = [&](const json& a, const json& b) {
    return a["evaluations_per_time"] <= b["evaluations_per_time"] && a[value] < b[value];
  };
  std::size_t in_front = 0;
  for (const auto& row : all["rows"]) {
    if (row["error"].is_null()) continue;
    bool beaten = false;
    for (const auto& other : all["rows"]) beaten = beaten || (!other["error"].is_null() && beats(other, row));
    const json place{{"method", row["method"]}, {"step", row["step"]}};
    const auto& front = ranking["front_by_evaluations"];
    BOOST_TEST((std::find(front.begin(), front.end(), place) != front.end()) == !beaten, place);
    in_front += beaten ? 0 : 1;
  }
  BOOST_TEST(in_front == ranking["front_by_evaluations"].size());
  BOOST_TEST(in_front < all["rows"].size());

  const auto cost_at = [&](std::size_t level, const std::string& method) {
    for (const auto& entry : ranking["levels"][level]["methods"]) {
      if (entry["method"] == method) return entry["evaluations_per_time"];
    }
    return json();
  };
  // Verlet crosses 0.1 between two of its rows, on a line of logarithms.
  std::vector<std::pair<double, double>> rows;  // cost and error
  for (const auto& row : all["rows"]) {
    if (row["method"] == "verlet") rows.emplace_back(row["evaluations_per_time"], row[value]);
  }
  std::sort(rows.rbegin(), rows.rend());
  const auto above =
      std::find_if(rows.begin(), rows.end(), [](const auto& row) { return row.second >= 0.1; });
  BOOST_TEST_REQUIRE((above != rows.begin() && above != rows.end()));
  const auto below = above - 1;
  const double share = std::log(0.1 / below->second) / std::log(above->second / below->second);
  const double expected = below->first * std::pow(above->first / below->first, share);
  const auto found = cost_at(0, "verlet");
  BOOST_TEST(found["kind"] == "found");
  BOOST_TEST(found["at"].get<double>() == expected, boost::test_tools::tolerance(1e-12));  // rounding
  BOOST_TEST(found["standard_error"] > 0.0);
  BOOST_TEST(found["standard_error"] < 0.2 * expected);
  BOOST_TEST(cost_at(1, "verlet")["kind"] == "above from first");
  BOOST_TEST(cost_at(2, "learned:nystrom")["kind"] == "below all");
}
