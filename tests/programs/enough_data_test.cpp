// SPDX-License-Identifier: BSL-1.0
// The program learns until its data are enough, and warns where a scheme meets other energies than it has
// seen.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/forged.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

const std::string coarse = " --step 0.03 --fine-step 0.001 --horizon 0.3 ";

json document(const std::string& arguments) {
  const finished done = run(arguments + " --json");
  BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
  BOOST_TEST(done.err == "");
  return json_of(done);
}

/// One folder with a scheme of forty trajectories.
struct learned {
  scratch folder{"energies"};
  learned() {
    const finished done =
        run(folder, "learn --family nystrom --trajectories 40 --output scheme.json" + coarse);
    BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
  }
};

bool warns_of_energies(const std::string& text) {
  return text.find("starts have energies outside") != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_doubles_the_trajectories_until_they_are_enough) {
  const double share = 5e-5;
  const auto fit = document("learn --family nystrom --loss state:1 --enough 5e-5" + coarse);
  const auto& stops = fit["enough"]["stops"];
  BOOST_TEST_CONTEXT(fit["enough"].dump()) {
    BOOST_TEST(fit["enough"]["reached"] == true);
    BOOST_REQUIRE(stops.size() >= 2U);
    BOOST_TEST(stops[0]["trajectories"] == 50);
    for (std::size_t n = 1; n < stops.size(); ++n) {
      BOOST_TEST(stops[n]["trajectories"].get<int>() == 2 * stops[n - 1]["trajectories"].get<int>());
      BOOST_TEST(stops[n - 1]["excess_share"].get<double>() > share);
    }
    BOOST_TEST(stops.back()["excess_share"].get<double>() <= share);
    BOOST_TEST(fit["excess_share"] == stops.back()["excess_share"]);
    BOOST_TEST(fit["trajectories"] == stops.back()["trajectories"]);
  }
  // As many at once tell the same, to the bit.
  const auto at_once =
      document("learn --family nystrom --loss state:1 --trajectories " + fit["trajectories"].dump() + coarse);
  BOOST_TEST(at_once["parameters"] == fit["parameters"]);
  BOOST_TEST(at_once["held_out_loss"] == fit["held_out_loss"]);
  BOOST_TEST(at_once["energy_range"] == fit["energy_range"]);
  BOOST_TEST(at_once["enough"].is_null());
}

BOOST_AUTO_TEST_CASE(a_curve_may_take_other_numbers_at_each_step) {
  const scratch folder("enough_curve");
  const finished done = run(folder,
                            "learn --family nystrom --enough 1e-4 --steps 0.01,0.06 --fine-step 0.001 "
                            "--horizon 0.3 --output curve.json");
  BOOST_TEST(done.code == 0, done.err);
  const auto scheme = json::parse(contents(folder / "curve.json"));
  BOOST_TEST_CONTEXT(scheme["trajectories"].dump()) {
    BOOST_TEST((scheme["trajectories"].is_array() || scheme["trajectories"] >= 50));
  }
  BOOST_TEST(run(folder, "run --method curve.json --step 0.06 --horizon 0.3").code == 0);
}

BOOST_AUTO_TEST_CASE(for_people_the_course_is_told) {
  const finished done = run("learn --family nystrom --enough 1" + coarse);
  BOOST_TEST(done.code == 0);
  BOOST_TEST(done.out.find("50 trajectories are enough") != std::string::npos, done.out);
  BOOST_TEST(done.out.find("to the loss on new data") != std::string::npos, done.out);
}

BOOST_AUTO_TEST_CASE(what_contradicts_it_is_refused) {
  const auto refused = [](const std::string& arguments, const std::string& words) {
    const finished done = run("learn --family nystrom" + coarse + arguments);
    return done.code == 2 && done.err.find(words) != std::string::npos;
  };
  BOOST_TEST(refused("--enough 0.01 --trajectories 50", "leave --trajectories away"));
  BOOST_TEST(refused("--enough 0", "--enough must be a positive"));
  BOOST_TEST(refused("--enough nan", "--enough"));
  BOOST_TEST(refused("--enough 0.01 --loss covariance --friction 1 --temperature 1",
                     "must come with a loss that learns from trajectories, got covariance"));
}

BOOST_FIXTURE_TEST_CASE(starts_like_those_that_were_learned_from_give_no_warning, learned) {
  for (const std::string many : {"1", "20", "1000"}) {
    const finished done =
        run(folder, "run --method scheme.json --step 0.03 --horizon 0.03 --trajectories " + many);
    BOOST_TEST(done.code == 0);
    BOOST_TEST(done.err == "", many);
  }
  const auto compared = json_of(run(folder,
                                    "compare --methods scheme.json,verlet --steps 0.03 --fine-step 0.001 "
                                    "--horizon 0.3 --trajectories 400 --json"));
  BOOST_TEST(!warns_of_energies(compared["warnings"].dump()));
}

BOOST_FIXTURE_TEST_CASE(starts_of_other_energies_give_one, learned) {
  const std::string hot = "run --method scheme.json --step 0.03 --horizon 0.03 --trajectories 20 --spread 3";
  const finished spoken = run(folder, hot);
  BOOST_TEST(spoken.code == 0);
  BOOST_TEST_CONTEXT(spoken.err) {
    BOOST_TEST(spoken.err.starts_with("nysalt: warning: scheme.json: "));
    BOOST_TEST(warns_of_energies(spoken.err));
    BOOST_TEST(spoken.err.find('\n') == spoken.err.size() - 1);
  }
  const finished quiet = run(folder, hot + " --json");
  BOOST_TEST(quiet.err == "");
  BOOST_TEST(warns_of_energies(json_of(quiet)["warnings"].dump()));
  const auto compared = json_of(run(folder,
                                    "compare --methods scheme.json,verlet --steps 0.03 --fine-step 0.001 "
                                    "--horizon 0.3 --trajectories 20 --spread 3 --json"));
  BOOST_TEST(warns_of_energies(compared["warnings"].dump()));
}

BOOST_FIXTURE_TEST_CASE(ranges_that_cannot_be_are_refused, learned) {
  const std::string text = contents(folder / "scheme.json");
  const auto refused = [&](const std::function<void(json&)>& change, const std::string& words) {
    std::ofstream(folder / "other.json", std::ios::binary) << forged(text, change);
    const finished done = run(folder, "run --method other.json --step 0.03 --horizon 0.03");
    return done.code == 2 && done.err.find(words) != std::string::npos;
  };
  BOOST_TEST(refused([](json& s) { s["energy_range"] = {2.0, 1.0}; }, "the least and the largest energy"));
  BOOST_TEST(refused([](json& s) { s["energy_range"] = {2.0}; }, "the least and the largest energy"));
  BOOST_TEST(refused([](json& s) { s["energy_range"] = "all"; }, "list of numbers"));
  BOOST_TEST(refused([](json& s) { s["trajectories"] = 0; }, "\"trajectories\" must be positive"));
  BOOST_TEST(
      refused([](json& s) { s["trajectories"] = json::array(); }, "\"trajectories\" must be positive"));
  // Without a range there is nothing to warn of.
  std::ofstream(folder / "other.json", std::ios::binary)
      << forged(text, [](json& s) { s["energy_range"] = nullptr; });
  BOOST_TEST(run(folder, "run --method other.json --step 0.03 --horizon 0.03 --spread 3").err == "");
}
