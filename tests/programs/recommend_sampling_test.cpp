// SPDX-License-Identifier: BSL-1.0
// recommend --for sampling: its steps against chains and against theory, its winner, and what it refuses.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <string>

#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/program.hpp"

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
  // All but the time that it took is the same of equal seeds, for any number of threads.
  json again = json_of(run(folder, larger + " --threads 3"));
  BOOST_TEST(again["rows"] == all["rows"]);
}

BOOST_AUTO_TEST_CASE(states_may_be_given_in_a_file) {
  const scratch folder("recommend_states");
  const auto drawn =
      run(folder, "sample " + chain + "--length 2 --method bcss3 --draws 100 --output draws.csv");
  BOOST_TEST_REQUIRE(drawn.code == 0, drawn.err);
  const json all =
      json_of(run(folder, line + chain + "--start draws.csv --families bab3 --json --trajectories 64"));
  BOOST_TEST(all["states"].get<std::string>().find("400 positions") != std::string::npos, all["states"]);
  const auto text = run(folder, line + chain + "--start draws.csv --families bab3 --trajectories 64");
  BOOST_TEST(text.code == 0, text.err);
  BOOST_TEST(text.out.find(all["advice"].get<std::string>()) != std::string::npos, text.out);
  const auto larger =
      run(folder, line + chain + "--start draws.csv --families bab3 --trajectories 64 --times-larger 1000");
  BOOST_TEST(larger.out.find("the choice of the word matters here") != std::string::npos, larger.out);
}

// Trajectories of a tenth of a radian in one dimension.
BOOST_AUTO_TEST_CASE(where_nothing_is_rejected_it_says_so) {
  const json all = document(
      "recommend --for sampling --system oscillator --omega 1 --length 0.1 --families bab3 "
      "--trajectories 16 --learn-trajectories 4");
  BOOST_TEST(row_of(all, "verlet")["is_longest"] == true);
  BOOST_TEST(all["advice"].get<std::string>().find("accepted more often than asked") != std::string::npos,
             all["advice"]);
}

BOOST_AUTO_TEST_CASE(what_no_sampler_can_be_recommended_for_is_one_line) {
  const scratch folder("recommend_sampling_bad");
  const std::string sampling = "--for sampling " + chain;
  all_refused(
      folder,
      after("recommend",
            {
                {"--for fun " + chain, {"unknown purpose 'fun'", "runs, sampling"}},
                {sampling, {"--length must be given"}},
                {sampling + "--length 0", {"--length must be"}},
                {sampling + "--length 1 --acceptance 1", {"--acceptance must be between 0 and 1"}},
                {sampling + "--length 1 --times-larger 0", {"--times-larger must be"}},
                {sampling + "--length 1 --trajectories 3", {"--trajectories must be at least 16"}},
                {sampling + "--length 1 --budget 3", {"--budget must come with --for runs"}},
                {sampling + "--length 1 --horizon 3", {"--horizon must come with --for runs"}},
                {sampling + "--length 1 --friction 1 --temperature 1", {"must have no bath"}},
                {sampling + "--length 1 --families aba3_free", {"not reversible"}},
                {sampling + "--length 1 --families bab33", {"unknown family"}},
                {chain + "--length 1 --horizon 1 --budget 3", {"--length must come with --for sampling"}},
                {chain + "--budget 3", {"--horizon must be given"}},
            }));
}
