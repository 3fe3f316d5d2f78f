// SPDX-License-Identifier: BSL-1.0
// Stability known beforehand: margins, highest frequencies and safe steps are right.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "../support/program.hpp"
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

/// Whether all of 8 trajectories of that many steps stayed bounded.
bool is_bounded(const std::string& what, double step, int steps) {
  std::ostringstream line;
  line << "run" << what << at(step) << " --trajectories 8 --sample-every 100000 --json --horizon "
       << (steps + 0.5) * step;
  const auto done = run(line.str());
  BOOST_TEST((done.code == 0 || done.code == 3), done.err);
  return json_of(done)["diverged"].empty();
}

}  // namespace

// Of one frequency: 1 - z/limit, with the limits that are known in closed form.
BOOST_AUTO_TEST_CASE(margins_are_the_analytic_ones) {
  const double s = 1.0 - 2.0 * 0.19318332750378357396;  // [mclachlan_1995]
  const double of_mclachlan = std::sqrt(8.0 / (1.0 + std::sqrt(1.0 - 4.0 * s * (1.0 - s))));
  const double k = s * (1.0 - s) / 8.0;  // trace/2 = 1 - z^2/2 + k z^4
  const double quarter_of_mclachlan = std::sqrt((0.5 - std::sqrt(0.25 - 4.0 * k)) / (2.0 * k));
  struct known {
    const char* method;
    double limit;
    double quarter;  // z at which trace/2 = 0
  };
  for (const auto& [method, limit, quarter] :
       {known{"verlet", 2.0, std::sqrt(2.0)}, known{"verlet_2x", 4.0, 4.0 * std::sin(std::numbers::pi / 8.0)},
        known{"mclachlan2", of_mclachlan, quarter_of_mclachlan}, known{"baoab", 2.0, std::sqrt(2.0)}}) {
    for (const double step : {0.03, 0.055}) {
      const auto all =
          document(std::string("stability --system oscillator --omega 50 --method ") + method + at(step));
      BOOST_TEST_CONTEXT(method << " at " << step) {
        const double z = 50.0 * step;
        // Where windows touch an end is known to the square root of rounding.
        BOOST_TEST(std::abs(all["margin"].get<double>() - (1.0 - z / limit)) < 1e-7);
        BOOST_TEST(all["stable"] == (z < limit));
        BOOST_TEST(all["bands"][0]["margin"] == all["margin"]);
        BOOST_TEST(all["highest_z"] == z, tolerance(4 * eps));
        BOOST_TEST(std::abs(all["stable_steps"][0][1].get<double>() - limit / 50.0) < 1e-8);
        BOOST_TEST(std::abs(all["linear_step"].get<double>() - 0.95 * quarter / 50.0) < 1e-8);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(highest_frequencies_are_the_known_ones) {
  const auto of = [](const std::string& system) {
    return document("stability --method verlet --step 0.01 --system " + system);
  };
  const auto known = [](const json& all, const char* source, double highest) {
    BOOST_TEST(all["frequency_source"] == source);
    BOOST_TEST(all["highest_frequency"].get<double>() == highest, tolerance(8 * eps));
  };
  known(of("oscillator --omega 7"), "declared", 7.0);
  known(of("pendulum"), "declared", 1.0);
  known(of("henon_heiles"), "declared", std::sqrt(3.0));
  known(of("linear_chain --masses 8"), "declared", 2.0 * std::sin(4.0 * std::numbers::pi / 9.0));

  // At the pericentre, which few of 64 starts are near.
  const auto of_kepler = of("kepler --eccentricity 0.9");
  known(of_kepler, "met by rare starts", std::sqrt(2.0 / std::pow(1.0 - 0.9, 3)));
  BOOST_TEST(of_kepler["declared"].is_null());
  BOOST_TEST(of_kepler["along_starts"] < 0.9 * of_kepler["of_law"].get<double>());
  BOOST_TEST(of_kepler["starts"] == 64);
  // On a circle all states are alike: across the pull the stiffness is 1/r^3 = 1, along it -2/r^3, no
  // frequency but as fast a motion. Estimates are known to 1 %, and rounded outwards.
  const auto on_circle = of("kepler --eccentricity 0");
  BOOST_TEST(on_circle["of_law"].get<double>() == std::sqrt(2.0), tolerance(8 * eps));
  BOOST_TEST(on_circle["along_starts"] >= 1.0 - 1e-9);
  BOOST_TEST(on_circle["along_starts"] <= 1.01);
  for (const char* linear : {"oscillator", "linear_chain --masses 8"}) {
    const auto all = of(linear);
    const double seen = all["along_starts"];
    BOOST_TEST(seen >= all["declared"].get<double>() * (1.0 - 1e-9));
    BOOST_TEST(seen <= all["declared"].get<double>() * 1.01);
  }
  // A cluster starts at rest, and is stiffer later.
  const auto of_cluster = of("lennard_jones");
  BOOST_TEST(of_cluster["frequency_source"] == "met by rare starts");
  BOOST_TEST(of_cluster["along_starts"] < of_cluster["of_law"].get<double>());

  // Starts beyond the energy that bands are declared for.
  const auto hot = of("fpu --omega 5 --spread 10");
  BOOST_TEST(hot["frequency_source"] == "seen along 64 starts");
  BOOST_TEST(hot["highest_frequency"] == hot["along_starts"]);
  BOOST_TEST(hot["highest_frequency"] > 1.1 * hot["declared"].get<double>());
  BOOST_TEST(of("fpu --omega 5")["frequency_source"] == "declared");
}

// Below the largest stable step runs are bounded, and above they diverge. Of the chain the highest mode is at
// the band's end, and grows by acosh(trace/2) = 0.2 a step there.
BOOST_AUTO_TEST_CASE(runs_just_below_the_limit_are_bounded_and_above_diverge) {
  for (const char* what : {" --system fpu --method verlet", " --system linear_chain --method mclachlan2"}) {
    const auto all = document(std::string("stability") + what + " --step 0.01");
    const double largest = all["stable_steps"][0][1];
    const double safe = all["safe_step"];
    BOOST_TEST_CONTEXT(what) {
      BOOST_TEST(safe < largest);
      BOOST_TEST(is_bounded(what, safe, 20'000));
      BOOST_TEST(is_bounded(what, 0.99 * largest, 20'000));
      BOOST_TEST(!is_bounded(what, 1.01 * largest, 20'000));
    }
  }
}

// phi^4 declares its band for the usual law of starts; with twice the spread a start has more energy. Above
// the safe step they diverge that the declared band still calls stable.
BOOST_AUTO_TEST_CASE(rare_starts_count) {
  const std::string what = " --system phi4 --spread 2 --method verlet";
  const auto all = document("stability" + what + " --step 0.3");
  BOOST_TEST(all["declared"].get<double>() * 0.3 < 2.0);
  BOOST_TEST(all["stable"] == false);
  BOOST_TEST(all["trial"]["passed"] == false);
  BOOST_TEST(is_bounded(what, all["safe_step"], 2000));
  BOOST_TEST(!is_bounded(what, 0.3, 2000));
}

// Impulses on phi^4: no mode is magnified much by itself, and runs are lost all the same.
BOOST_AUTO_TEST_CASE(words_that_rotate_are_tried) {
  const std::string what = " --system phi4 --spread 0.3 --method impulse";
  const auto all = document("stability" + what + " --step 0.8");
  BOOST_TEST(all["stable"] == false);
  BOOST_TEST(all["trial"]["passed"] == false);
  BOOST_TEST(document("stability" + what + " --step 0.1")["stable"] == true);
}
