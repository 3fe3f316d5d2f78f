// SPDX-License-Identifier: BSL-1.0
// recommend --for sampling: its steps against chains and against theory, and its winner.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "../support/program.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

/// A chain whose modes lie between 0.7 and 4 rad per unit time.
const std::string chain = "--system linear_chain --masses 8 --spring 4 ";
const std::string line = "recommend --for sampling --length 2 --learn-trajectories 20 ";

const json& row_of(const json& all, const std::string& method) {
  for (const auto& row : all["rows"]) {
    if (row["method"] == method) return row;
  }
  throw std::runtime_error("no row of " + method);
}

}  // namespace

// Within 4 standard errors of the step the acceptance of chains passes 0.9.
BOOST_AUTO_TEST_CASE(chains_at_the_step_are_accepted_as_often_as_asked) {
  const scratch folder("recommend_sampling");
  const json all = json_of(run(folder, line + chain + "--families bab3 --json --trajectories 200"));
  BOOST_TEST(all["rows"].size() == 12U);
  for (const char* method : {"verlet", "bcss3"}) {
    const double step = row_of(all, method)["step_size"];
    const double error = row_of(all, method)["standard_error"].get<double>() /
                         row_of(all, method)["step_per_evaluation"].get<double>();
    const auto accepted = [&](double h) {
      const json found =
          json_of(run(folder, fmt::format("sample {}--length 2 --method {} --step {} --burn-in "
                                          "200 --draws 2000 --chains 16 --json",
                                          chain, method, h)));
      return found["acceptance"].get<double>();
    };
    // Chains share their 2000 durations, over which the acceptance varies by 0.1 at most.
    const double of_chains = 4.0 * 0.1 / std::sqrt(2000.0);
    BOOST_TEST(accepted(step * (1.0 - 4.0 * error)) >= 0.9 - of_chains, method);
    BOOST_TEST(accepted(step * (1.0 + 4.0 * error)) <= 0.9 + of_chains, method);
    BOOST_TEST(4.0 * error < 0.2);
    BOOST_TEST(accepted(1.3 * step) < 0.9 - of_chains);
  }
  double last = 1e300;  // the best first
  for (const auto& row : all["rows"]) {
    if (row["step_size"].is_null()) continue;
    BOOST_TEST(row["step_per_evaluation"].get<double>() <= last);
    last = row["step_per_evaluation"];
    BOOST_TEST(row["step_per_evaluation"].get<double>() * row["evaluations_per_step"].get<double>() ==
                   row["step_size"].get<double>(),
               boost::test_tools::tolerance(1e-12));
  }
}

// Of a system 1000 times larger, a learned word of four stages beats all formulas, and the scheme of it is
// written.
BOOST_AUTO_TEST_CASE(on_a_larger_system_what_is_learned_wins) {
  const scratch folder("recommend_larger");
  const std::string larger = line + chain +
                             "--families bab4 --times-larger 1000 --learn-loss gaussian_acceptance --output "
                             "word.json --json";
  const json all = json_of(run(folder, larger));
  BOOST_TEST(all["verdict"] == "learned", all["advice"]);
  BOOST_TEST(all["winner"] == "learned:bab4");
  BOOST_TEST(all["ratio"]["value"].get<double>() > 1.0 + 2.0 * all["ratio"]["standard_error"].get<double>());
  BOOST_TEST(all["diagnostic"]["value"].get<double>() > 2.0);  // errors of order h^4 count more and more
  BOOST_TEST(all["output"] == "word.json");
  BOOST_TEST(contents(folder / "word.json").find("gaussian_acceptance") != std::string::npos);
  // The scheme at its own step: a thousandth of the energy error, 3e-5, leaves 0.997.
  const double learned_at = row_of(all, "learned:bab4")["learned_at"];
  const auto accepted = [&](const std::string& method, double step) {
    return json_of(run(folder, fmt::format("sample {}--length 2 --method {} --step {} --draws 500 --json",
                                           chain, method, step)))["acceptance"]
        .get<double>();
  };
  BOOST_TEST(accepted("word.json", learned_at) > 0.99);
  BOOST_TEST(accepted("verlet", 0.25 * learned_at) < 0.95);  // at its cost
  const json at_hand = json_of(run(folder, line + chain + "--families bab3 --json"));
  BOOST_TEST(row_of(at_hand, "verlet")["step_size"].get<double>() >
             2.0 * row_of(all, "verlet")["step_size"].get<double>());
}

BOOST_AUTO_TEST_CASE(recommend_sampling) { run_table("recommend_sampling"); }
