// SPDX-License-Identifier: BSL-1.0
// `nysalt_paper` runs every exhibit of the paper, writes what it promises, and judges by numbers. Its
// options, help and refusals are in cases/options.txt.
#include <boost/test/unit_test.hpp>

#include <map>
#include <set>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

bool is_verdict(const std::string& text) {
  return text == "reproduced" || text == "not reproduced" || text.starts_with("depends on ");
}

/// The only item whose claim holds these words.
json item(const json& all, const std::string& words) {
  json found;
  int count = 0;
  for (const auto& one : all["items"]) {
    if (one["claim"].get<std::string>().find(words) == std::string::npos) continue;
    found = one;
    ++count;
  }
  BOOST_REQUIRE_MESSAGE(count == 1, count << " items tell of " << words);
  return found;
}

void must_be_whole(const json& all) {
  for (const auto& one : all["items"]) {
    for (const char* key : {"part", "exhibit", "place", "claim", "quantity", "ours", "verdict", "reason"}) {
      BOOST_TEST(!one[key].get<std::string>().empty(), key << " of " << one.dump());
    }
    BOOST_TEST(is_verdict(one["verdict"]), one["verdict"]);
    BOOST_TEST((one["command"].is_null() || one["command"].get<std::string>().starts_with("nysalt ")));
    for (const char* none : {"nan", "inf "}) {
      BOOST_TEST(one["ours"].get<std::string>().find(none) == std::string::npos, one["ours"]);
    }
  }
}

}  // namespace

// What follows from formulas, and so does not depend on a seed. The same is derived in
// docs/theory-langevin-optimum.md and, for the windows, in values_test.
BOOST_AUTO_TEST_CASE(the_linear_claims_have_known_verdicts) {
  const auto all = document("linear");
  must_be_whole(all);
  const std::map<std::string, std::string> known{
      {"b1* = 0.5", "depends on the weights of the loss"},
      {"independent of Omega", "depends on the weights of the loss"},
      {"independent of delta", "depends on how large the step is"},
      {"beta2 = 1 - beta1", "not reproduced"},
      {"sqrt(20/3)/omega", "reproduced"},
      {"sqrt(5/3)", "reproduced"},
      {"second window", "reproduced"},
      {"real parts", "not reproduced"},
      {"is enlarged", "depends on what is counted"},
      {"0.43 gamma", "depends on the step"},
      {"strong order is 1.5", "reproduced"}};
  BOOST_TEST(all["items"].size() == known.size());
  for (const auto& [words, verdict] : known) {
    BOOST_TEST(item(all, words)["verdict"].get<std::string>().starts_with(verdict), words);
  }
  BOOST_TEST(item(all, "b1* = 0.5")["ours"].get<std::string>().find("0.40058") != std::string::npos);
  BOOST_TEST(item(all, "sqrt(5/3)")["ours"] == "1.2909944487");
  BOOST_TEST(item(all, "0.43 gamma")["ours"].get<std::string>().find("-0.3770") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(quick_runs_go_through_all_exhibits_and_write_them) {
  const scratch folder("paper");
  const auto done = run(folder, "--quick --json --output results");
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  const auto all = json_of(done);
  must_be_whole(all);
  BOOST_TEST(all["quick"] == true);
  std::set<std::string> parts;
  std::set<std::string> exhibits;
  for (const auto& one : all["items"]) {
    parts.insert(one["part"]);
    exhibits.insert(one["exhibit"]);
  }
  BOOST_TEST((parts == std::set<std::string>{"linear", "deterministic", "langevin"}));
  BOOST_TEST(exhibits.size() == 23U);
  for (const char* file : {"paper.md", "paper.html", "paper.json"}) {
    BOOST_TEST(!contents(folder / "results" / file).empty(), file);
  }
  const auto markdown = contents(folder / "results" / "paper.md");
  BOOST_TEST(markdown.find("no weight") != std::string::npos);  // of the verdicts of a quick run
  for (const auto& exhibit : exhibits) BOOST_TEST(markdown.find(exhibit) != std::string::npos, exhibit);
  auto written = json::parse(contents(folder / "results" / "paper.json"));
  BOOST_TEST(written["made"]["machine"].get<std::string>().find(" cores") != std::string::npos);
  BOOST_TEST(written["items"] == all["items"]);
  for (const char* picture :
       {"parameters_against_omega", "accuracy_T_05", "energies_at_400", "law_distance"}) {
    BOOST_TEST(!contents(folder / "results" / "paper" / (std::string(picture) + ".dat")).empty(), picture);
  }
}
