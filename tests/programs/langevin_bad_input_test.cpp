// SPDX-License-Identifier: BSL-1.0
// What is typed wrong of a bath, of placements and of statistics: one line that says what, where and what to
// do; nothing printed, nothing written.
#include <boost/test/unit_test.hpp>

#include <functional>
#include <vector>

#include "../support/bad_input.hpp"
#include "../support/forged.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

void all_refused(const std::vector<bad>& cases) { all_refused(scratch("langevin_bad_input"), cases); }

// Sound beginnings, of the system that is burned in fastest: what follows makes them bad.
const std::string in_the_bath = " --friction 1 --temperature 0.5";
const std::string run_it =
    "run --system oscillator --omega 1 --step 0.1 --horizon 1 --output out.csv --method ";
const std::string learn =
    "learn --family nystrom --system oscillator --omega 1 --step 0.1 --trajectories 3 --output scheme.json";
const std::string compare =
    "compare --system oscillator --omega 1 --horizon 2 --trajectories 20 --output folder --methods ";
const std::string statistics = compare + "baoab --steps 0.1" + in_the_bath + " --metric ";

void write(const scratch& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
}

std::string table(const std::string& letters, const std::string& coefficients, const std::string& more = "") {
  return R"({"format": "nysalt table", "version": 1, "letters": ")" + letters + R"(", "coefficients": [)" +
         coefficients + "]" + more + "}";
}

}  // namespace

// Else every case below could be refused for its beginning.
BOOST_AUTO_TEST_CASE(the_beginnings_are_sound) {
  BOOST_TEST(run(run_it + "verlet@end" + in_the_bath).code == 0);
  BOOST_TEST(run(learn + in_the_bath + " --force").code != 2);
  BOOST_TEST(run(compare + "baoab --steps 0.1" + in_the_bath).code == 0);
  BOOST_TEST(run(statistics + "distribution --range 0,2").code == 0);
  BOOST_TEST(run(statistics + "acf").code == 0);
}

BOOST_AUTO_TEST_CASE(a_bath_is_given_once_and_whole) {
  for (const std::string& beginning : {run_it + "verlet", learn, compare + "verlet --steps 0.1"}) {
    all_refused(
        after(beginning, {{"--friction -1 --sigma 1", {"--friction", "not negative", "-1"}},
                          {"--friction 1 --sigma -2", {"--sigma", "not negative", "-2"}},
                          {"--friction 1 --temperature -3", {"--temperature", "not negative", "-3"}},
                          {"--friction 1 --sigma 1 --temperature 1", {"--sigma", "--temperature", "one"}},
                          {"--friction 0 --sigma 0 --temperature 0", {"--sigma", "--temperature", "one"}},
                          {"--sigma 1", {"--sigma must come with --friction"}},
                          {"--temperature 1", {"--temperature must come with --friction"}},
                          {"--friction 1", {"--friction must come with --sigma or --temperature"}},
                          {"--friction nan --sigma 1", {"--friction", "finite", "nan"}},
                          {"--friction 1 --sigma 1e999", {"--sigma", "finite", "1e999"}},
                          {"--friction '' --sigma 1", {"--friction"}},
                          {"--friction 1 --sigma 0.05x", {"--sigma", "0.05x"}},
                          {"--friction 1e308 --temperature 1e308",
                           {"--friction", "--temperature", "finite product", "1e+308"}}}));
  }
  all_refused({{"list --friction 1", {"'--friction'", "--help"}}});
}

BOOST_AUTO_TEST_CASE(starts_and_placements_have_names) {
  for (const std::string& beginning : {run_it + "verlet", learn, compare + "verlet --steps 0.1"}) {
    all_refused(
        after(beginning + in_the_bath, {{"--start nosuch", {"'nosuch'", "law, gibbs, trajectory"}},
                                        {"--start ''", {"--start", "empty"}},
                                        {"--placement nosuch", {"'nosuch'", "end, symmetric, middle"}},
                                        {"--placement ''", {"--placement", "empty"}}}));
    for (const char* bath :
         {"", " --friction 1 --temperature 0", " --friction 0 --sigma 1", " --friction 0 --temperature 1"}) {
      for (const char* start : {" --start gibbs", " --start trajectory"})
        all_refused({{beginning + bath + start, {start, "temperature above 0", "--friction"}}});
    }
  }
  for (const char* bath : {"", " --friction 1 --temperature 0.5"}) {
    all_refused({{run_it + "verlet@nosuch" + bath, {"'nosuch'", "end, symmetric, middle"}},
                 {run_it + "verlet@" + bath, {"''", "end, symmetric, middle"}},
                 {run_it + "verlet@END" + bath, {"'END'", "end, symmetric, middle"}},
                 {run_it + "nosuch@end" + bath, {"'nosuch'", "nysalt list"}},
                 {run_it + "verlet@end@end" + bath, {"'verlet@end'"}},
                 {run_it + "@end" + bath, {"''", "nysalt list"}},
                 {run_it + "baoab@end" + bath, {"baoab@end", "BAOAB"}},
                 {compare + "aboba@symmetric --steps 0.1" + bath, {"aboba@symmetric", "ABOBA"}},
                 {compare + "learned:nosuch@end --steps 0.1" + bath, {"'nosuch'", "nysalt list"}},
                 {compare + "verlet@end,verlet@end --steps 0.1" + bath, {"verlet@end", "twice"}}});
  }
  all_refused({{run_it + "learned:nystrom@end" + in_the_bath,
                {"learned first", "nysalt learn --family nystrom --placement end"}}});
}

BOOST_AUTO_TEST_CASE(tables_hold_the_noise_of_a_path) {
  const scratch folder("langevin_tables");
  write(folder, "short.json", table("BAOAB", "0.5, 0.5, 0.9, 0.5, 0.5"));
  write(folder, "back.json", table("OBABO", "1.5, 0.5, 1, 0.5, -0.5"));
  write(folder, "alone.json", table("O", "1"));
  write(folder, "uneven.json", table("OBABO", "0.31415926, 0.5, 1, 0.5, 0.68584074"));
  write(folder, "even.json", table("ABBA", "0.5, 0.5, 0.5, 0.5"));
  write(folder, "placed.json", table("BAB", "0.5, 1, 0.5", R"(, "placement": "end")"));
  write(folder, "baoab.json", table("BAOAB", "0.5, 0.5, 1, 0.5, 0.5"));
  for (const std::string& bath : {std::string(), in_the_bath}) {
    all_refused(folder, {{run_it + "short.json" + bath, {"short.json", "0.9", "step"}},
                         {run_it + "back.json" + bath, {"back.json", "-0.5", "forward in time"}},
                         {run_it + "alone.json" + bath, {"alone.json", "letter"}},
                         {run_it + "uneven.json" + bath, {"uneven.json", "equal parts"}},
                         {run_it + "placed.json" + bath, {"placed.json", "placement", "O"}},
                         {run_it + "baoab.json@end" + bath, {"baoab.json@end", "BAOAB"}}});
  }
  all_refused(folder,
              {{run_it + "even.json@middle" + in_the_bath, {"even.json@middle", "central letter"}},
               {run_it + "even.json --placement middle" + in_the_bath, {"even.json", "central letter"}},
               {"stability --method short.json", {"short.json", "0.9"}}});
  BOOST_TEST(run(folder, run_it + "baoab.json" + in_the_bath).code == 0);
  BOOST_TEST(run(folder, run_it + "even.json@end" + in_the_bath).code == 0);
}

BOOST_AUTO_TEST_CASE(schemes_of_a_bath_have_version_2_and_a_placement) {
  const scratch folder("langevin_forgeries");
  BOOST_REQUIRE(run(folder, learn + in_the_bath + " --force").err.find("nysalt: nysalt") ==
                std::string::npos);
  const std::string sound = contents(folder / "scheme.json");
  BOOST_REQUIRE(json::parse(sound)["version"] == 2);
  const auto forge = [&](const std::string& name, const std::function<void(json&)>& change) {
    write(folder, name, forged(sound, change));
  };
  forge("same.json", [](json&) {});
  forge("old.json", [](json& d) { d["version"] = 1; });
  forge("new.json", [](json& d) { d["version"] = 4; });
  forge("bare.json", [](json& d) { d.erase("placement"); });
  forge("nowhere.json", [](json& d) { d["placement"] = "nosuch"; });
  forge("number.json", [](json& d) { d["placement"] = 1; });
  write(folder, "edited.json", std::string(sound).replace(sound.find("symmetric"), 9, "middle"));
  const std::string line = in_the_bath + " --force";  // whatever the fit was
  all_refused(folder,
              {{run_it + "old.json" + line, {"old.json", "\"version\"", "got 1", "placement"}},
               {run_it + "new.json" + line, {"new.json", "\"version\" must be at most 3", "got 4"}},
               {run_it + "bare.json" + line, {"bare.json", "\"version\"", "got 2", "placement"}},
               {run_it + "nowhere.json" + line, {"nowhere.json", "'nosuch'", "end, symmetric, middle"}},
               {run_it + "number.json" + line, {"number.json", "placement", "text"}},
               {run_it + "edited.json" + line, {"edited.json", "checksum"}},
               {run_it + "scheme.json@end" + line, {"scheme.json@end", "OABABAO"}}});
  BOOST_TEST(run(folder, run_it + "same.json" + line).code == 0);
}

BOOST_AUTO_TEST_CASE(fine_steps_divide_the_intervals_of_the_noise) {
  // In halves where O stands at both ends.
  all_refused(after(learn + in_the_bath,
                    {{"--fine-step 0.03", {"0.1", "must divide the step 0.1", "0.03", "--fine-step"}},
                     {"--fine-step 0.1", {"0.1", "2 equal parts", "--fine-step"}},
                     {"--fine-step 0.02", {"0.1", "2 equal parts", "0.02"}}}));
  all_refused(after(compare + "obabo --steps 0.1" + in_the_bath, {{"--fine-step 0.02", {"2 equal parts"}}}));
  BOOST_TEST(run(compare + "baoab --steps 0.1 --fine-step 0.02" + in_the_bath).code == 0);
  all_refused(
      {{compare + "baoab --steps 0.1 --friction 1e9 --temperature 1", {"fine steps", "smaller step"}}});
}

BOOST_AUTO_TEST_CASE(metrics_that_say_nothing_there) {
  const std::string baoab = compare + "baoab --steps 0.1 ";
  all_refused(
      {{baoab + in_the_bath + " --metric energy", {"energy", "bath", "path"}},
       {baoab + in_the_bath + " --metric exchange", {"exchange", "harmonic_oscillator"}},
       {baoab + "--friction 0 --sigma 1 --metric distribution", {"distribution", "temperature", "heats"}},
       {baoab + "--friction 0 --sigma 1 --metric acf", {"acf", "temperature", "heats"}}});
}

BOOST_AUTO_TEST_CASE(histograms_and_lags_are_in_place) {
  all_refused(after(statistics + "distribution",
                    {{"--range 1", {"--range", "two numbers", "1"}},
                     {"--range 0,1,2", {"--range", "two numbers", "3"}},
                     {"--range 1,1", {"--range", "LOW below HIGH", "1,1"}},
                     {"--range 2,1", {"--range", "LOW below HIGH", "2,1"}},
                     {"--range=-1e308,1e308", {"--range", "finite width"}},
                     {"--range 0,nan", {"--range", "'nan'", "finite"}},
                     {"--range 0,,1", {"--range", "empty"}},
                     {"--range 100,200", {"--range", "100,200", "energy"}},
                     {"--bins 0", {"--bins", "at least 1"}},
                     {"--bins 2.5", {"--bins", "whole"}},
                     {"--bins 100001", {"--bins", "at most 100000"}},
                     {"--longest-lag 1", {"--longest-lag", "acf"}},
                     {"--observable nosuch", {"'nosuch'"}},
                     {"--fine-step 0.03", {"0.1", "must divide the step 0.1", "0.03"}}}));
  all_refused(
      after(statistics + "acf", {{"--longest-lag 0", {"--longest-lag", "positive"}},
                                 {"--longest-lag -1", {"--longest-lag", "positive"}},
                                 {"--longest-lag 0.05", {"--longest-lag", "at least one step of 0.1"}},
                                 {"--longest-lag 2", {"--longest-lag", "--horizon 2", "longer"}},
                                 {"--longest-lag 1e300", {"--longest-lag", "1e+300"}},
                                 {"--range 0,1", {"--range", "distribution"}},
                                 {"--bins 5", {"--bins", "distribution"}}}));
  all_refused(after(statistics + "path", {{"--bins 5", {"--bins", "distribution", "path"}},
                                          {"--range 0,1", {"--range", "distribution", "path"}},
                                          {"--longest-lag 1", {"--longest-lag", "acf", "path"}}}));
}

// Bounded below energy 1/6 alone: a bath leads over it.
BOOST_AUTO_TEST_CASE(a_motion_that_is_not_confined_has_no_gibbs_law) {
  const std::string hot = " --system henon_heiles --friction 0.1 --temperature 0.05 ";
  for (const char* start : {"--start gibbs", "--start trajectory"}) {
    all_refused({{"run --method baoab --step 0.1 --horizon 1 --output out.csv" + hot + start,
                  {"henon_heiles", "diverged", "must be confined", "--start law"}}});
  }
  for (const char* system : {" --system kepler", " --system lennard_jones"}) {
    const std::string run_it =
        "run --method baoab --step 0.01 --horizon 0.1 --friction 0.1 --temperature 0.05";
    for (const char* start : {"", " --start gibbs", " --start trajectory"}) {
      all_refused({{run_it + system + start, {"must have a bound", "--start law"}}});
    }
    BOOST_TEST(run(run_it + system + " --start law").code == 0);
  }
  all_refused({{"compare --methods baoab --steps 0.1 --horizon 30 --start law --metric distribution" + hot,
                {"reference", "diverged"}}});
  BOOST_TEST(run("run --method baoab --step 0.1 --horizon 1 --start law" + hot).code == 0);
}

BOOST_AUTO_TEST_CASE(a_spread_belongs_to_the_law_of_starts) {
  const std::string run_it =
      "run --system phi4 --method baoab --step 0.1 --horizon 1 --friction 1 --temperature 1 --spread 2";
  all_refused({{run_it + " --output out.csv", {"--spread", "--start law"}}});
  BOOST_TEST(run(run_it + " --start law").code == 0);
}
