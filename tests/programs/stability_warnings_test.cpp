// SPDX-License-Identifier: BSL-1.0
// Runs are warned where they are near an end of stability, `stability` draws the curve, and safe steps were
// tried.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/rounding.hpp"

using namespace nysalt::test;
using boost::test_tools::tolerance;
using json = nlohmann::ordered_json;

namespace {

/// --step as it is read back to the bit.
std::string at(double step) {
  std::ostringstream text;
  text.precision(17);
  text << " --step " << step;
  return text.str();
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// Some of these runs diverge.
json warnings_of(const std::string& arguments, const scratch& folder = scratch("warned")) {
  const auto done = run(folder, "run --json --sample-every 1000" + arguments);
  BOOST_TEST((done.code == 0 || done.code == 3), done.err);
  BOOST_TEST(done.err == "");
  return json_of(done)["warnings"];
}

}  // namespace

// Verlet on the pendulum is the standard map: beyond h = .986 no invariant circle is left.
BOOST_AUTO_TEST_CASE(a_safe_step_was_tried) {
  const auto safe_step = [](const std::string& system, const std::string& method) {
    return document("stability --system " + system + " --method " + method + " --step 0.01")["safe_step"];
  };
  for (const char* spread : {"", " --spread 2"}) {
    BOOST_TEST(safe_step("pendulum" + std::string(spread), "verlet").get<double>() < 0.986);
  }
  // Where frequencies have no bound, and of words that rotate, nothing is promised.
  BOOST_TEST(safe_step("kepler", "verlet").is_null());
  BOOST_TEST(safe_step("fpu", "impulse").is_null());
}

BOOST_AUTO_TEST_CASE(a_run_is_warned_of_a_small_margin) {
  const std::string what = " --system fpu --method verlet --horizon 0.1";
  BOOST_TEST(warnings_of(what + " --step 0.03").empty());
  const auto told = warnings_of(what + " --step 0.036");
  BOOST_REQUIRE(told.size() == 1U);
  for (const char* words :
       {"verlet at step 0.036", "% from the end of a stability window", "50 to 50.3", "steps up to 0.0266"})
    BOOST_TEST(has(told[0], words), told[0] << " lacks " << words);
  // What is named is not warned of.
  BOOST_TEST(warnings_of(what + " --step 0.0266").empty());
  BOOST_TEST(!warnings_of(what + " --step 0.0319").empty());

  const auto unstable = warnings_of(what + " --step 0.042");
  BOOST_REQUIRE(unstable.size() == 1U);
  BOOST_TEST(has(unstable[0], "not linearly stable at step 0.042"));
  BOOST_TEST(has(unstable[0], "steps up to 0.0266"));

  // Without --json it is a line on standard error.
  const auto said = run("run --step 0.036" + what);
  BOOST_TEST(said.code == 0);
  BOOST_TEST(is_one_line(said.err));
  BOOST_TEST(has(said.err, "warning: verlet at step 0.036"));
  BOOST_TEST(run("run --step 0.03" + what).err == "");
}

// In the window behind the gap too: at its beginning, and in the gap.
BOOST_AUTO_TEST_CASE(a_run_is_warned_near_a_gap) {
  const scratch folder("gap");
  // The two-stage word (1/2, 2/5): windows 0 .. sqrt(20/3) and sqrt(10) .. sqrt(50/3).
  std::ofstream(folder / "gap.json") << R"({
    "format": "nysalt table", "version": 1, "name": "gap", "letters": "ABABA",
    "coefficients": [0.2, 0.5, 0.6, 0.5, 0.2]})";
  const auto warnings = [&](double z) {
    return warnings_of(" --system oscillator --omega 50 --method gap.json --horizon 1" + at(z / 50.0),
                       folder);
  };
  const double again = std::sqrt(10.0);
  const double last = std::sqrt(50.0 / 3.0);
  BOOST_TEST(warnings(0.79 * std::sqrt(20.0 / 3.0)).empty());
  BOOST_TEST(has(warnings(2.4)[0], "from the end of a stability window"));
  BOOST_TEST(has(warnings(2.9)[0], "not linearly stable"));
  BOOST_TEST(has(warnings(again * 1.01)[0], "from the end of a stability window"));
  BOOST_TEST(has(warnings(last * 0.99)[0], "from the end of a stability window"));
  BOOST_TEST(has(warnings(last * 0.99)[0], "steps up to 0.0289"));  // .95 of z = 1.524, where trace/2 is 0
  const auto all =
      document("stability --system oscillator --omega 50 --method gap.json" + at(3.5 / 50.0), folder);
  BOOST_TEST(all["stable"] == true);
  BOOST_REQUIRE(all["gaps"].size() == 1U);
  BOOST_TEST(all["gaps"][0][1].get<double>() == again, tolerance(100 * eps));
  BOOST_TEST(all["stable_steps"].size() == 2U);
}

// BCSS' three stages are stable up to 4.66, and at 2.976 two windows touch.
BOOST_AUTO_TEST_CASE(a_run_is_warned_where_windows_touch) {
  const std::string what = " --system fpu --method bcss3 --horizon 0.1 --step ";
  const auto told = warnings_of(what + "0.0594");
  BOOST_REQUIRE(told.size() == 1U);
  BOOST_TEST(has(told[0], "z = 2.976, where two stability windows touch"), told[0]);
  BOOST_TEST(warnings_of(what + "0.055").empty());
  BOOST_TEST(warnings_of(what + "0.063").empty());
  const auto all = document("stability --system fpu --method bcss3 --step 0.0594");
  BOOST_TEST(all["touching"].size() == 1U);
  BOOST_TEST(all["bands"][0]["touching"].is_null());
  BOOST_TEST(all["bands"][1]["touching"] == all["touching"][0]);
  BOOST_TEST(all["margin"] > 0.3);
}

// Nonlinear motion suffers there, though it is linearly stable below and above: the Henon-Heiles system of
// frequency 1 loses many of 64 trajectories at h = 3.05, and few or none at 2.3.
BOOST_AUTO_TEST_CASE(where_windows_touch_nonlinear_motion_suffers) {
  const auto lost = [](const char* step) {
    return document(std::string("run --system henon_heiles --method bcss3 --trajectories 64 --horizon 1500 "
                                "--sample-every 100000 --step ") +
                    step)["diverged"]
        .size();
  };
  BOOST_TEST(lost("2.3") == 0U);
  BOOST_TEST(lost("3.05") > 10U);
}

// Its bands are for an energy; these starts have more.
BOOST_AUTO_TEST_CASE(a_run_is_warned_of_its_own_starts) {
  const std::string what = " --system fpu --omega 5 --method verlet --horizon 1 --step 0.2";
  BOOST_TEST(warnings_of(what).empty());
  const auto told = warnings_of(what + " --spread 10");
  BOOST_REQUIRE(told.size() == 1U);
  BOOST_TEST(has(told[0], "seen along 16 starts"), told[0]);
}

BOOST_AUTO_TEST_CASE(the_curve_is_that_of_verlet) {
  const scratch folder("curve");
  const auto all = document("stability --method verlet --system fpu --step 0.05 --output out.csv", folder);
  BOOST_TEST(all["output"] == "out.csv");
  BOOST_TEST((folder.files() == std::set<std::string>{"manifest.json", "out.csv"}));
  std::istringstream lines(contents(folder / "out.csv"));
  std::string line;
  std::getline(lines, line);
  BOOST_TEST(line == "z,half_trace");
  double z = -1.0;
  double half_trace = 0.0;
  char comma = 0;
  int rows = 0;
  while (lines >> z >> comma >> half_trace) {
    if (rows == 0) BOOST_TEST(z == 0.0);
    // 1 - z^2/2 by a few operations.
    BOOST_TEST(std::abs(half_trace - (1.0 - 0.5 * z * z)) <= 8.0 * eps * (1.0 + z * z));
    ++rows;
  }
  BOOST_TEST(rows > 1000);
  BOOST_TEST(z == 1.3 * all["highest_z"].get<double>(), tolerance(4 * eps));
}

BOOST_AUTO_TEST_CASE(a_picture_lies_beside_it) {
  const scratch folder("picture");
  const auto done = run(folder, "stability --method bcss3 --system fpu --step 0.04 --output out.csv --plot");
  BOOST_TEST(done.code == 0);
  BOOST_TEST(has(done.out, "Written: out.csv"));
  for (const char* name : {"out.csv", "out.gp", "out.dat", "out.svg", "out.png"})
    BOOST_TEST(folder.files().contains(name), name);
  const auto script = contents(folder / "out.gp");
  for (const char* words : {"'stable'", "'frequencies of the system'", "'windows touch'"})
    BOOST_TEST(has(script, words), words);
}

BOOST_AUTO_TEST_CASE(words_that_rotate_are_asked_what_soft_forces_do) {
  const auto alone = document("stability --method impulse");
  BOOST_TEST(alone["limit"].is_null());
  BOOST_TEST(alone["windows"].empty());
  const double resonance = std::numbers::pi / 50.0;
  const std::string what = "stability --method impulse --system fpu";
  const auto there = document(what + at(resonance));
  BOOST_TEST(there["stable"] == false);
  BOOST_TEST(there["magnification"]["factor"] > 3.0);
  BOOST_TEST(std::abs(there["magnification"]["mode"].get<double>() - 50.0) < 1e-9);
  BOOST_REQUIRE(there["warnings"].size() == 1U);
  BOOST_TEST(has(there["warnings"][0], "it does not"));
  const auto before = document(what + at(0.9 * resonance));
  BOOST_TEST(before["stable"] == true);
  BOOST_TEST(before["warnings"].empty());
  BOOST_TEST(before["resonance"]["step"].get<double>() == resonance, tolerance(1e-9));
  BOOST_TEST(before["resonance"]["multiple"] == 1);
  BOOST_TEST(document(what + at(1.9 * resonance))["resonance"]["multiple"] == 2);
}
