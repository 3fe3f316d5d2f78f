// SPDX-License-Identifier: BSL-1.0
// recommend: what holds by the clock, and of heavy tails. Tier 1 has budgets of evaluations and errors in
// tests/programs/recommend_test.cpp.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <set>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

const std::string few = "--trajectories 24 --learn-trajectories 8 ";

const json* row_of(const json& all, const std::string& method) {
  for (const auto& row : all["rows"]) {
    if (row["method"] == method) return &row;
  }
  return nullptr;
}

}  // namespace

// A rotation counts its soft forces alone, and takes as long as many of them: what wins by evaluations loses
// to what does more of them in the same seconds. By how much depends on the machine; it was 100 and more.
BOOST_AUTO_TEST_CASE(seconds_decide_too) {
  const auto all = document("recommend --system fpu --budget 60 --horizon 2 --families aba6,r_fg4 " + few);
  BOOST_TEST(all["winner"] == "learned:r_fg4");
  const auto& by_seconds = all["by_seconds"];
  // Which other wins depends on the machine too; of a tie the classical one is taken.
  const std::string winner = by_seconds[by_seconds["winner"].is_null() ? "best_classical" : "winner"];
  BOOST_TEST(winner != "learned:r_fg4");
  const json first = *row_of(all, "learned:r_fg4");
  const json fast = *row_of(by_seconds, winner);
  BOOST_TEST(fast["error"].get<double>() < 0.2 * first["error"].get<double>());
  // Equal seconds; timings of one method differ by a few percent, of two in a busy machine by more.
  const double ratio = fast["seconds_per_time"].get<double>() / first["seconds_per_time"].get<double>();
  BOOST_TEST(ratio == 1.0, boost::test_tools::tolerance(0.3));
  BOOST_TEST(fast["evaluations_per_time"].get<double>() > 100.0);
  const std::string advice = all["advice"];
  BOOST_TEST(advice.find("Take learned:r_fg4") != std::string::npos, advice);
  BOOST_TEST(advice.find("By seconds another wins") != std::string::npos, advice);
  BOOST_TEST(advice.find(winner) != std::string::npos, advice);
}

BOOST_AUTO_TEST_CASE(a_budget_of_seconds_gives_equal_seconds) {
  const std::string line = "recommend --system henon_heiles --horizon 10 --families fg4 " + few;
  // What Verlet's 20 evaluations take here, whatever the machine: no row then has fewer than ten steps.
  const auto by_evaluations = document(line + "--budget 20");
  const double seconds = (*row_of(by_evaluations, "verlet"))["seconds_per_time"];
  const auto all = document(line + fmt::format("--budget-seconds {:.17g}", seconds));
  BOOST_TEST(all["budget_seconds"] == seconds);
  BOOST_TEST(all["rows"].size() >= 12U);
  std::set<double> budgets;
  for (const auto& one : all["rows"]) {
    if (!one["reason"].is_null()) {  // on a machine that is busier by now, fewer than ten steps
      const std::string reason = one["reason"];
      BOOST_TEST(reason.find("of its steps of") != std::string::npos, reason);
      continue;
    }
    BOOST_TEST(one["seconds_per_time"].get<double>() == seconds, boost::test_tools::tolerance(1e-9));
    budgets.insert(one["evaluations_per_step"].get<double>() / one["step_size"].get<double>());
  }
  BOOST_TEST_REQUIRE(budgets.size() > 1U);
  BOOST_TEST(*budgets.rbegin() > 1.05 * *budgets.begin());  // and hence unequal evaluations
}

// Trajectories near the separatrix decide the mean: of 400, its error bars cover the value of 40,000 in one
// of 16 samples. What is claimed instead holds on other seeds.
BOOST_AUTO_TEST_CASE(what_is_said_of_a_heavy_tail_holds_on_other_seeds) {
  const auto all = document("recommend --system pendulum --error 0.01 --horizon 20 --families fg4 --seed 1");
  BOOST_TEST(all["judged_by"] == "quantile");
  const auto& row = *row_of(all, all["winner"].is_null() ? all["best_classical"] : all["winner"]);
  BOOST_TEST(row["confirmed"]["upper_bound"].get<double>() <= 0.01);
  // The method at its step on other seeds, by what 95 of 100 trajectories stay below.
  const auto name = row["method"].get<std::string>();
  for (const int seed : {7, 8, 9}) {
    const auto again = document(
        fmt::format("recommend --system pendulum --budget {:.17g} --horizon 20 --families fg4 --trajectories "
                    "400 --seed {}",
                    row["evaluations_per_step"].get<double>() / row["step_size"].get<double>(), seed));
    BOOST_TEST((*row_of(again, name))["quantile_95"].get<double>() <= 0.01, name);
  }
}

// What is advised holds where it is run.
BOOST_AUTO_TEST_CASE(what_is_advised_holds) {
  for (const std::string budget : {"1.6", "2", "3"}) {
    const auto all = document("recommend --system pendulum --horizon 10 --families aba6 --seed 2 --budget " +
                              budget + " " + few);
    for (const char* kind : {"best_learned", "best_classical"}) {
      if (all[kind].is_null() || all[kind].get<std::string>().starts_with("learned:")) continue;
      const auto& row = *row_of(all, all[kind]);
      const auto done = run(fmt::format(
          "run --system pendulum --method {} --step {:.17g} --horizon 100 --seed 2 --output o.csv --json",
          row["method"].get<std::string>(), row["step_size"].get<double>()));
      BOOST_TEST(done.code == 0);
      const std::string verdict = json_of(done)["judgement"]["verdict"];
      BOOST_TEST((verdict == "good" || verdict == "near an edge"), verdict);
    }
    for (const auto& row : all["rows"]) {
      if (row["method"] != "learned:aba6" || row["step_size"].get<double>() < 2.5) continue;
      BOOST_TEST(all["winner"] != "learned:aba6");  // 3.0 is 4 % from the end of a window
    }
  }
}
