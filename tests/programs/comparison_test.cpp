// SPDX-License-Identifier: BSL-1.0
// What the rows of a comparison are worth: references, null models, floors, horizons, marks and rankings.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../support/document.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

// As fine as the rows need, and no finer; what is asked for is taken.
BOOST_AUTO_TEST_CASE(a_reference_is_as_fine_as_its_rows_need) {
  const std::string line = "compare --steps 0.006 --trajectories 20 --horizon 1 --methods ";
  const auto reference = [&](const std::string& rest) { return document(line + rest)["references"][0]; };
  const auto coarse = reference("verlet");
  const auto fine = reference("verlet,srkn11b");
  BOOST_TEST(coarse["reference"] == "srkn11b with step 0.003");  // omega h below 0.2
  BOOST_TEST(fine["reference"] != coarse["reference"]);
  BOOST_TEST(fine["error"] < 0.5 * coarse["error"].get<double>());
  BOOST_TEST(reference("verlet --fine-step 1e-4")["reference"] == "srkn11b with step 0.0001");
  for (const std::string rest : {"verlet", "verlet,srkn6b", "pefrl,srkn11b"}) {
    const auto all = document(line + rest);
    for (const auto& row : all["rows"]) {
      BOOST_TEST(row["reference_error"] < 0.05 * row["error"].get<double>(), rest << ": " << row["method"]);
    }
  }
  // One that is as coarse as the method is marked, and its row is not ranked.
  const auto poor = document(line + "srkn11b --fine-step 0.006");
  BOOST_TEST(poor["rows"][0]["marks"].dump().find("reference") != std::string::npos);
  BOOST_TEST(poor["rankings"][0]["front_by_evaluations"].empty());
}

// Metrics beside each other have the numbers that each has alone.
BOOST_AUTO_TEST_CASE(several_metrics_are_those_of_each) {
  const std::string line =
      "compare --methods verlet,srkn6b --steps 0.02 --trajectories 20 --horizon 1 --fine-step 1e-3 --metric ";
  const std::vector<std::string> metrics{"path:q1",           "state", "energy",
                                         "path:stiff_energy", "acf",   "distribution"};
  std::string joined;
  for (const auto& metric : metrics) joined += (joined.empty() ? "" : ",") + metric;
  const std::string lags = " --longest-lag 0.5";
  const auto all = document(line + joined + lags);
  BOOST_REQUIRE(all["rows"].size() == 2 * metrics.size());
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    const auto alone = document(line + metrics[m] + (metrics[m] == "acf" ? lags : ""));
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& row = all["rows"][2 * m + k];
      BOOST_TEST(row["error"] == alone["rows"][k]["error"]);
      BOOST_TEST(row["marks"] == alone["rows"][k]["marks"]);
    }
  }
  BOOST_TEST(all["rows"][0]["error"] != all["rows"][6]["error"]);
}

// What the flow conserves is no worse at its start: it is no model, and chaos does not touch it.
BOOST_AUTO_TEST_CASE(the_error_of_what_is_conserved_is_ranked) {
  for (const std::string system : {"oscillator --omega 1", "pendulum", "henon_heiles"}) {
    const auto all = document(
        "compare --methods verlet,srkn6b --steps 0.1 --trajectories 16 --horizon 5 --metric "
        "path:energy --system " +
        system);
    BOOST_TEST(all["references"][0]["null_model"].is_null());
    for (const auto& row : all["rows"]) BOOST_TEST(row["marks"].empty(), system << ": " << row);
    BOOST_TEST(all["rankings"][0]["front_by_evaluations"].size() == 2U);
  }
}

// BAOAB has the law of an oscillator's q at any step: its distance is sampling, at large steps and at small.
BOOST_AUTO_TEST_CASE(a_floor_is_of_as_many_samples_as_the_row) {
  const auto all = document(
      "compare --system oscillator --omega 1 --friction 1 --temperature 1 --methods baoab,obabo --steps "
      "0.05,1.5 "
      "--horizon 60 --metric distribution:q1 --bins 20 --trajectories 256");
  for (const std::size_t row : {0U, 1U, 2U}) BOOST_TEST(all["rows"][row]["marks"] == json::array({"floor"}));
  BOOST_TEST(
      all["rows"][3]["marks"].empty());  // OBABO at 1.5 has another law: (1 - (h/2)^2)^-1 of the variance
  BOOST_TEST(all["rows"][2]["floor"] > 1.2 * all["rows"][0]["floor"].get<double>());  // samples forget slowly
}

// Fronts and costs are those of the rows beside them.
BOOST_AUTO_TEST_CASE(rankings_follow_from_the_rows) {
  const auto all = document(
      "compare --methods verlet,mclachlan2,srkn6b,learned:nystrom --steps 0.0025,0.005,0.01,0.02 "
      "--equal-cost "
      "--trajectories 20 --metric state --horizon 1 --levels 0.1,1e-9,100");
  const auto beats = [](const json& a, const json& b) {
    return a["evaluations_per_time"] <= b["evaluations_per_time"] && a["error"] < b["error"];
  };
  const auto& ranking = all["rankings"][0];
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
    for (const auto& its : ranking["levels"][level]["methods"]) {
      if (its["method"] == method) return its["evaluations_per_time"];
    }
    return json();
  };
  // Verlet crosses 0.1 between two of its rows, on a line of logarithms.
  std::vector<std::pair<double, double>> rows;  // cost and error
  for (const auto& row : all["rows"]) {
    if (row["method"] == "verlet") rows.emplace_back(row["evaluations_per_time"], row["error"]);
  }
  std::sort(rows.rbegin(), rows.rend());
  const auto above =
      std::find_if(rows.begin(), rows.end(), [](const auto& its) { return its.second >= 0.1; });
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

// What stays at its start, and for how long a path can be followed.
BOOST_AUTO_TEST_CASE(rows_are_seen_against_a_null_model_and_a_horizon) {
  const auto at = [](const std::string& horizon) {
    return document("compare --methods srkn6b,verlet --steps 0.01 --trajectories 16 --horizon " + horizon);
  };
  const auto marks = [](const json& all, std::size_t row) { return all["rows"][row]["marks"]; };
  const auto brief = at("20");
  BOOST_TEST(brief["references"][0]["predictable_until"].is_null());
  BOOST_TEST(brief["references"][0]["null_model"] > brief["rows"][0]["error"]);
  BOOST_TEST(marks(brief, 0) == json::array());
  BOOST_TEST(marks(brief, 1) == json::array({"null"}));  // its phase is lost
  BOOST_TEST(!brief["rankings"][0]["front_by_evaluations"].empty());
  // Chaos of rate 0.2 or so makes of a millionth what it likes in ln(10^6)/0.2 = 70 or more.
  const auto longer = at("400");
  const double until = longer["references"][0]["predictable_until"];
  BOOST_TEST(until > 50.0);
  BOOST_TEST(until < 400.0);
  for (const auto& row : longer["rows"]) BOOST_TEST(row["marks"].dump().find("horizon") != std::string::npos);
  BOOST_TEST(longer["rankings"][0]["front_by_evaluations"].empty());
}
