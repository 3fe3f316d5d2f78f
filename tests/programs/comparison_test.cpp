// SPDX-License-Identifier: BSL-1.0
// What the rows of a comparison are worth: references, null models, floors, horizons, marks and rankings.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../support/document.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

/// But for `tail`, which so few trajectories as tests take often have.
json marks_of(const json& row) {
  json result = json::array();
  for (const auto& mark : row["marks"]) {
    if (mark != "tail") result.push_back(mark);
  }
  return result;
}

bool is_marked(const json& row, const std::string& mark) {
  const auto& all = row["marks"];
  return std::find(all.begin(), all.end(), mark) != all.end();
}

}  // namespace

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

// Beside each row the margin of `stability` at the step that is taken; a step beyond the window has none
// left.
BOOST_AUTO_TEST_CASE(margins_are_those_of_stability) {
  const auto all =
      document("compare --system phi4 --methods verlet,pefrl --steps 0.1,0.6 --horizon 6 --trajectories 3");
  for (const auto& row : all["rows"]) {
    const auto alone = document(fmt::format("stability --system phi4 --method {} --step {}",
                                            row["method"].get<std::string>(), row["step"].get<double>()));
    BOOST_TEST(row["stability_margin"] == alone["margin"]);
    BOOST_TEST((row["stability_margin"] > 0.0) == (row["step"] == 0.1));
  }
  const auto rotating = document("compare --methods impulse --steps 0.01 --trajectories 3");
  BOOST_TEST(rotating["rows"][0]["stability_margin"].is_null());
}

// A method whose coefficients follow from the step has rows where it has coefficients.
BOOST_AUTO_TEST_CASE(where_coefficients_end_there_is_no_row) {
  const std::string line =
      "compare --methods verlet,phase_fitted_pefrl --trajectories 3 --steps ";  // z <= 5.4
  const auto all = document(line + "0.01,0.2");
  int rows = 0;
  for (const auto& row : all["rows"]) rows += row["method"] == "phase_fitted_pefrl" ? 1 : 0;
  BOOST_TEST(all["rows"].size() == 3U);
  BOOST_TEST(rows == 1);
  BOOST_TEST(all["warnings"].dump().find("(no row at step 0.2)") != std::string::npos);
  for (const char* steps : {"0.2", "0.2,0.3"}) {
    const auto done = run(line + steps);
    BOOST_TEST(done.code == 2);
    BOOST_TEST(done.err.find("z = step * frequency must be at most") != std::string::npos, done.err);
  }
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
    for (const auto& row : all["rows"]) BOOST_TEST(marks_of(row).empty(), system << ": " << row);
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

// What stays at its start; for how long a path can be followed is in tests/long.
BOOST_AUTO_TEST_CASE(rows_are_seen_against_a_null_model) {
  const auto marks = [](const json& all, std::size_t row) { return marks_of(all["rows"][row]); };
  const auto brief = document("compare --methods srkn6b,verlet --steps 0.01 --trajectories 16 --horizon 20");
  BOOST_TEST(brief["references"][0]["predictable_until"].is_null());
  BOOST_TEST(brief["references"][0]["null_model"] > brief["rows"][0]["error"]);
  BOOST_TEST(marks(brief, 0) == json::array());
  BOOST_TEST(marks(brief, 1) == json::array({"null"}));  // its phase is lost
  BOOST_TEST(!brief["rankings"][0]["front_by_evaluations"].empty());
}

// srkn6b at .2 an evaluation has samples at 12, 13.2 and 14.4. Up to 13.19 and 13.21 it and Verlet err alike;
// means over whole steps alone would jump by the last of eleven, which is by far the worst.
BOOST_AUTO_TEST_CASE(rows_of_all_steps_are_judged_over_the_same_time) {
  const auto errors = [](const std::string& horizon) {
    const auto all = document(
        "compare --system pendulum --spread 0.5 --methods verlet,srkn6b --equal-cost --steps 0.2 --metric "
        "state "
        "--trajectories 100 --horizon " +
        horizon);
    return std::pair<double, double>(all["rows"][0]["error"], all["rows"][1]["error"]);
  };
  const auto [verlet, srkn6b] = errors("13.19");
  const auto [verlet_later, srkn6b_later] = errors("13.21");
  // Errors that grow like t: by .02/13.2.
  BOOST_TEST(verlet_later == verlet, boost::test_tools::tolerance(0.01));
  BOOST_TEST(srkn6b_later == srkn6b, boost::test_tools::tolerance(0.01));
  const auto whole_step_later = errors("14.4");
  BOOST_TEST(whole_step_later.second > 1.05 * srkn6b_later);
}

BOOST_AUTO_TEST_CASE(a_row_of_too_few_steps_says_so) {
  const auto all = document(
      "compare --system pendulum --methods verlet,srkn6b --equal-cost --steps 0.2 --metric state,acceptance "
      "--trajectories 16 --horizon 10");
  BOOST_TEST(!all["rows"][0].contains("reason"));
  const std::string reason = all["rows"][1]["reason"];
  BOOST_TEST(
      reason ==
      "--horizon must hold at least 10 steps of 1.2 for a mean over time, got 10, which holds 8.33; take "
      "at least 12");
  BOOST_TEST(all["rows"][1]["error"].is_null());
  BOOST_TEST(all["rows"][3]["acceptance"] > 0.0);  // that is of the end alone
}

// Some starts of the pendulum lie near its separatrix: of 40,000 trajectories a few say what the mean is.
BOOST_AUTO_TEST_CASE(a_mean_that_few_trajectories_decide_is_marked) {
  const auto all = document(
      "compare --system pendulum --methods srkn6b,chin4a --equal-cost --steps 0.1,0.177 --metric "
      "state,path:q1 "
      "--trajectories 400 --horizon 20");
  const auto& row = all["rows"][1];
  BOOST_TEST(row["method"] == "chin4a");
  BOOST_TEST(is_marked(row, "tail"));
  BOOST_TEST(row["enough_trajectories"] > 400.0);
  BOOST_TEST(row["deciding"] < 100.0);
  BOOST_TEST(row["median"] < row["error"]);
  BOOST_TEST(row["quantiles"]["50 %"] == row["median"]);
  BOOST_TEST(row["quantiles"]["5 %"] < row["median"]);
  BOOST_TEST(row["survivors"] == 400);
  BOOST_TEST(all["rankings"][0]["ranked_by"] == "median");
  BOOST_TEST(!all["rankings"][0]["front_by_evaluations"].empty());
  // A chain of springs has none, and its mean ranks.
  const auto chain = document(
      "compare --system linear_chain --methods verlet --steps 0.1 --metric state --trajectories 400 "
      "--horizon 10");
  BOOST_TEST(!is_marked(chain["rows"][0], "tail"));
  BOOST_TEST(chain["rankings"][0]["ranked_by"] == "mean");
}

// The level that methods cross, of 1, 2 and 5 times powers of ten.
BOOST_AUTO_TEST_CASE(levels_come_from_the_errors) {
  const auto all = document(
      "compare --system henon_heiles --methods verlet,mclachlan2 --equal-cost --steps 0.05,0.1,0.2 --metric "
      "state --trajectories 50 --horizon 10");
  const auto& levels = all["rankings"][0]["levels"];
  BOOST_REQUIRE(levels.size() == 1U);
  BOOST_REQUIRE(levels[0]["methods"].size() == 2U);
  for (const auto& entry : levels[0]["methods"]) BOOST_TEST(entry["evaluations_per_time"]["kind"] == "found");
  const double level = levels[0]["level"];
  const double digit = level / std::pow(10.0, std::floor(std::log10(level) + 1e-9));
  BOOST_TEST((std::abs(digit - 1.0) < 1e-9 || std::abs(digit - 2.0) < 1e-9 || std::abs(digit - 5.0) < 1e-9));
}
