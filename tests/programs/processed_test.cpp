// SPDX-License-Identifier: BSL-1.0
// Processed methods in the program: learned, kept in files, counted with their processors, and refused where
// they cannot be.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

const std::string system_of_few = "--system henon_heiles ";
const std::string learn =
    "learn " + system_of_few +
    "--family fg4+p3 --step 0.8 --horizon 16 --trajectories 24 --effort quick --output ";

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
}

std::string table(const std::string& letters, const std::vector<double>& coefficients) {
  return json{
      {"format", "nysalt table"}, {"version", 1}, {"letters", letters}, {"coefficients", coefficients}}
      .dump();
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_was_learned_runs_and_compares_from_its_file) {
  const scratch folder("processed");
  const finished learned = run(folder, learn + "scheme.json");
  BOOST_TEST_REQUIRE(learned.code == 0, learned.err);
  const json scheme = json::parse(contents(folder / "scheme.json"));
  BOOST_TEST(scheme["family"] == "fg4+p3");
  BOOST_TEST(scheme["parameters"].size() == 7U);
  const json ran =
      json_of(run(folder, "run " + system_of_few + "--method scheme.json --step 0.8 --horizon 16 --json"));
  BOOST_TEST(ran["rows"].size() == 21U);
  BOOST_TEST(ran["evaluations"] ==
             3 + 20 * (4 + 3));  // before the first step, and for each sample but the start
  const json compared =
      json_of(run(folder, "compare " + system_of_few +
                              "--methods scheme.json,fg4_processed,chin4a --steps 0.8 --horizon 16 "
                              "--trajectories 32 --metric state --json"));
  const auto& rows = compared["rows"];
  BOOST_TEST_REQUIRE(rows.size() == 3U);
  // Three and three, or seven and seven, evaluations in 20 steps of four over 16 units of time.
  const auto taken = [](const json& row) { return 16.0 * row["evaluations_per_time"].get<double>(); };
  BOOST_TEST(taken(rows[0]) == 86.0, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(taken(rows[1]) == 94.0, boost::test_tools::tolerance(1e-12));
  const auto is_marked = [](const json& row) {
    return row["marks"].dump().find("processed") != std::string::npos;
  };
  BOOST_TEST(is_marked(rows[0]));
  BOOST_TEST(is_marked(rows[1]));
  BOOST_TEST(!is_marked(rows[2]));
}

// A table of a user's own is measured: its order is that of n steps, the processor included.
BOOST_AUTO_TEST_CASE(tables_with_a_processor) {
  const scratch folder("processed_tables");
  const json known = json_of(run("stability --json --method takahashi_imada_processed"));
  auto c = known["coefficients"].get<std::vector<double>>();
  write(folder, "own.json", table("AGA|BABABA", c));
  const json own = json_of(run(folder, "stability --json --method own.json"));
  BOOST_TEST(own["order"] == 4);
  c[4] += 0.01;
  write(folder, "wrong.json", table("AGA|BABABA", c));
  write(folder, "letters.json", table("AGA|BAGABA", c));
  write(folder, "few.json", table("AGA|BA", c));
  all_refused(folder, {{"stability --method wrong.json", {"B of the processor adds up to 0.01", "to 0"}},
                       {"stability --method letters.json", {"A and B in turn"}},
                       {"stability --method few.json", {"10 coefficients"}}});
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const scratch folder("processed_refused");
  const std::string step = " --step 0.02 --horizon 0.2";
  const std::string bath = " --friction 0.1 --sigma 0.1";
  all_refused(folder,
              {{"learn --family fg4+p1" + step, {"2 to 8 pairs", "got 1"}},
               {"learn --family fg4+p9" + step, {"2 to 8 pairs", "got 9"}},
               {"learn --family fg4+px" + step, {"FAMILY+pPAIRS"}},
               {"learn --family fg4+p" + step, {"FAMILY+pPAIRS"}},
               {"learn --family fg5+p3" + step, {"fg5", "fg4"}},
               {"learn --family fg4+p3+p3" + step, {"fg4+p3"}},
               {"learn --family aba6_free+p3" + step, {"must be symmetric"}},
               {"learn --family r_aba4+p3" + step, {"letters A, B, D and G"}},
               {"learn --family fg4+p3" + step + bath, {"processor", "bath"}},
               {"compare --methods learned:fg4+p3 --steps 0.02" + bath, {"processed", "bath", "learned:fg4"}},
               {"run --method fg4_processed" + step + bath, {"processor", "bath"}},
               {"recommend --budget 80 --horizon 5 --looks 0", {"--looks"}}});
}

BOOST_AUTO_TEST_CASE(looks_are_paid_for) {
  const auto rows_of = [](const std::string& looks) {
    return document(
        "recommend " + system_of_few +
        "--budget 8 --horizon 30 --trajectories 24 --families fg_chin+p2 --learn-trajectories 12 " +
        looks)["rows"];
  };
  const auto step_of = [](const json& rows, const std::string& method) {
    for (const auto& row : rows) {
      if (row["method"] == method) return row["step_size"].get<double>();
    }
    BOOST_FAIL("no row of " + method);
    return 0.0;
  };
  const json once = rows_of("");
  const json often = rows_of("--looks 30");
  const auto expected = [](double evaluations, double pairs, double looks) {
    return evaluations / (8.0 - pairs * (1.0 + looks) / 30.0);
  };
  const auto close = boost::test_tools::tolerance(1e-12);
  BOOST_TEST(step_of(once, "learned:fg_chin+p2") == expected(3, 2, 1), close);
  BOOST_TEST(step_of(often, "learned:fg_chin+p2") == expected(3, 2, 30), close);
  BOOST_TEST(step_of(often, "takahashi_imada_processed") == expected(2, 3, 30), close);
  BOOST_TEST(step_of(often, "chin4a") == step_of(once, "chin4a"), close);
}
