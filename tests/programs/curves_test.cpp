// SPDX-License-Identifier: BSL-1.0
// theta(step) on disk: learned at several steps, used at these and between them, and nowhere else.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "../support/forged.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
}

bool refused(const finished& done, const std::vector<std::string>& words) {
  bool all = done.code == 2 && done.out.empty() && done.err.find('\n') == done.err.size() - 1;
  for (const auto& word : words) all = all && done.err.find(word) != std::string::npos;
  return all;
}

/// The state error of a method at a step, from the same starts whatever the method.
double error_at(const scratch& folder, const std::string& method, const std::string& step) {
  const finished done = run(folder,
                            "compare --system henon_heiles --trajectories 16 --horizon 8 --metric state "
                            "--learn-horizon 8 --learn-trajectories 20 "
                            "--json --methods verlet," +
                                method + " --steps " + step);
  BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
  const auto all = json_of(done);
  for (const auto& row : all["rows"]) {
    if (row["method"] == method) return row["error"];
  }
  return std::nan("");
}

/// One folder with one curve, learned once.
struct curve {
  scratch folder{"curve"};
  std::string text;
  json document;
  curve() {
    const finished done = run(
        folder,
        "learn --system henon_heiles --family fg_chin --trajectories 20 --horizon 8 --steps 0.8,0.4,1,0.6 "
        "--output curve.json");
    BOOST_REQUIRE_MESSAGE(done.code == 0, done.err);
    text = contents(folder / "curve.json");
    document = json::parse(text);
  }
};

}  // namespace

BOOST_FIXTURE_TEST_CASE(it_holds_each_parameter_at_each_step_in_their_order, curve) {
  BOOST_TEST(document["version"] == 3);
  BOOST_TEST((document["steps"] == json{0.4, 0.6, 0.8, 1.0}));
  for (const char* name : {"b", "c"}) BOOST_TEST(document["parameters"][name].size() == 4U);
  const finished again =
      run(folder,
          "learn --system henon_heiles --family fg_chin --trajectories 20 --horizon 8 --steps 0.4,0.6,0.8,1 "
          "--threads 1 --output again.json");
  BOOST_TEST(again.code == 0);
  BOOST_TEST((contents(folder / "again.json") == text));
}

BOOST_FIXTURE_TEST_CASE(between_its_steps_a_curve_does_as_well_as_what_is_learned_there, curve) {
  const double learned_there = error_at(folder, "learned:fg_chin", "0.72");
  const double between = error_at(folder, "curve.json", "0.72");
  const double of_a_neighbour = [&] {
    json other = document;
    for (auto& values : other["parameters"]) values = {values[0], values[0], values[0], values[0]};
    write(folder, "flat.json", forged(text, [&](json& s) { s = other; }));
    return error_at(folder, "flat.json", "0.72");  // what was learned at .4
  }();
  BOOST_TEST(between <= 1.1 * learned_there);
  BOOST_TEST(of_a_neighbour > 1.1 * learned_there);
}

BOOST_FIXTURE_TEST_CASE(beyond_its_ends_and_elsewhere_a_curve_is_refused, curve) {
  const std::string at = "run --system henon_heiles --horizon 4.2 --method curve.json --step ";
  BOOST_TEST(run(folder, at + "0.7").code == 0);
  BOOST_TEST(refused(run(folder, at + "0.35"), {"steps from 0.4 to 1", "0.35", "--force"}));
  BOOST_TEST(refused(run(folder, at + "1.05"), {"steps from 0.4 to 1", "1.05"}));
  BOOST_TEST(run(folder, at + "1.05 --force").code == 0);
  BOOST_TEST(refused(run(folder, "run --system pendulum --horizon 4 --method curve.json --step 0.4"),
                     {"henon_heiles", "pendulum"}));
}

BOOST_FIXTURE_TEST_CASE(one_that_is_not_whole_is_refused, curve) {
  struct change {
    std::function<void(json&)> of;
    std::vector<std::string> words;
  };
  const std::vector<change> changes{
      {[](json& s) { s["steps"] = json::array(); }, {"\"steps\""}},
      {[](json& s) { s["steps"] = 0.4; }, {"\"steps\"", "list"}},
      {[](json& s) { std::swap(s["steps"][0], s["steps"][1]); }, {"\"steps\"", "rise"}},
      {[](json& s) { s["steps"][0] = 0.0; }, {"positive"}},
      {[](json& s) { s["steps"].erase(0); }, {"\"b\"", "each step"}},
      {[](json& s) { s["step"] = 0.4; }, {"\"step\"", "\"steps\""}},
      {[](json& s) { s["parameters"]["b"] = 0.2; }, {"\"b\"", "list"}},
      {[](json& s) { s["parameters"]["c"][1] = nullptr; }, {"\"c\"", "number"}},
      {[](json& s) { s["parameters"]["b"][2] = 5.0; }, {"the parameter b", "5"}},
      {[](json& s) { s["version"] = 1; }, {"\"version\" must be 3", "several steps", "got 1"}},
      {[](json& s) { s["version"] = 4; }, {"\"version\"", "got 4", "newer"}}};
  for (const auto& forgery : changes) {
    write(folder, "forged.json", forged(text, forgery.of));
    const finished done =
        run(folder, "run --system henon_heiles --horizon 4 --step 0.4 --method forged.json");
    BOOST_TEST(refused(done, forgery.words), done.err);
  }
}

// Equal steps are stable far beyond each of two learned ones, and between them they need not be: two nystrom
// methods, both good for their step, whose mean has a gap.
BOOST_AUTO_TEST_CASE(between_its_steps_a_curve_must_be_stable) {
  const scratch folder("unstable_curve");
  const finished learned =
      run(folder, "learn --system fpu --family nystrom --steps 0.04,0.05 --output curve.json");
  BOOST_REQUIRE_MESSAGE(learned.code == 0, learned.err);
  const std::string text = contents(folder / "curve.json");
  // In between the word of Verlet's drift-kick-drift: unstable from z = 2 on, here 2.25 to 2.26.
  write(folder, "forged.json", forged(text, [](json& s) {
          s["parameters"]["b1"] = {0.5, 0.5};
          s["parameters"]["beta1"] = {0.5, 0.5};
        }));
  const std::string at = "run --horizon 0.45 --method forged.json --step 0.045";
  BOOST_TEST(refused(run(folder, at), {"forged.json", "between the steps", "0.045", "not linearly stable"}));
  BOOST_TEST(run(folder, "run --horizon 0.45 --method curve.json --step 0.045").code == 0);
}

// Two stages have no parameter for the phase of stiff springs, which at .04 turn by 2 rad a step; four do.
BOOST_AUTO_TEST_CASE(a_fit_says_how_far_it_follows) {
  scratch folder{"followed"};
  const auto learned = [&](const std::string& family) {
    return run(folder, "learn --system fpu --trajectories 20 --horizon 4 --step 0.04 --family " + family).out;
  };
  const std::string line = "\n  trajectories          it";
  BOOST_TEST(learned("nystrom").find(line) != std::string::npos);
  BOOST_TEST(learned("aba4").find("\n  trajectories") == std::string::npos);
  const auto of = [&](const std::string& family) {
    return json_of(run(
        folder, "learn --system fpu --trajectories 20 --horizon 4 --step 0.04 --json --family " + family));
  };
  BOOST_TEST(of("nystrom")["followed_steps"].get<int>() < 100);
  BOOST_TEST(of("aba4")["followed_steps"] == 100);
  BOOST_TEST(of("aba4")["trajectory_steps"] == 100);
}
