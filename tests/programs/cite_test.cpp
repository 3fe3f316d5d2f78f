// SPDX-License-Identifier: BSL-1.0
// `nysalt cite` names the works that a set-up rests on, and no others.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <set>
#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

std::set<std::string> keys(const finished& done) {
  BOOST_TEST(done.code == 0, done.err);
  std::set<std::string> all;
  const json document = json_of(done);
  for (const auto& work : document.at("references")) {
    const std::string key = work.at("key");
    BOOST_TEST(all.insert(key).second, key << " is there twice");
    BOOST_TEST(!work.at("for").empty());
  }
  return all;
}

std::set<std::string> cited(const scratch& folder, const std::string& setup) {
  return keys(run(folder, "cite --json " + setup));
}

void must_be_told(const scratch& folder, const std::string& setup, const std::string& words) {
  const auto done = run(folder, "cite " + setup);
  BOOST_TEST(done.code == 2);
  BOOST_TEST(done.out.empty());
  BOOST_TEST(done.err.find(words) != std::string::npos, done.err);
  BOOST_TEST(std::ranges::count(done.err, '\n') == 1);
}

const std::set<std::string> always{"nysalt", "li_lu_tao_ye_2023", "eigen"};

const std::set<std::string> random_numbers{"salmon_2011", "box_muller_1958"};

std::set<std::string> with(const std::set<std::string>& these, std::set<std::string> more = {}) {
  more.insert(these.begin(), these.end());
  more.insert(always.begin(), always.end());
  return more;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_part_of_a_setup_has_its_works) {
  const scratch folder("cite_parts");
  BOOST_TEST((cited(folder, "") == always));
  BOOST_TEST((cited(folder, "--methods verlet") == with({"verlet_1967"})));
  BOOST_TEST((cited(folder, "--system pendulum") == with(random_numbers)));
  BOOST_TEST((cited(folder, "--methods srkn6b,s_aia2") ==
              with({"blanes_moan_2002", "nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024"})));
  BOOST_TEST((cited(folder, "--methods phase_fitted_mclachlan5,omelyan_fg4") ==
              with({"van_de_vyver_2007", "omelyan_mryglod_folk_2003"})));
  BOOST_TEST((cited(folder, "--methods learned:nystrom") ==
              with({"okunbor_skeel_1992", "ceres", "blanes_moan_2002"})));
  BOOST_TEST(
      (cited(folder, "--bath --methods learned:fg_chin@symmetric") ==
       with(random_numbers, {"chin_1997", "ceres", "leimkuhler_matthews_2013", "leimkuhler_matthews_2015"})));
  BOOST_TEST((cited(folder, "--methods verlet --metric acceptance,path:q1") ==
              with({"verlet_1967", "duane_kennedy_pendleton_roweth_1987", "blanes_moan_2002"})));
  BOOST_TEST((cited(folder, "--metric acf") == with({"sokal_1997", "blanes_moan_2002"})));
  // The reference of a linear system is its exact flow.
  BOOST_TEST((cited(folder, "--system oscillator --metric state") == with(random_numbers)));
}

BOOST_AUTO_TEST_CASE(all_that_can_be_named_can_be_cited) {
  const scratch folder("cite_all");
  const json names = json_of(run(folder, "list --json"));
  std::set<std::string> sources;
  std::string methods;
  for (const auto& method : names.at("methods")) {
    sources.insert(method.at("source").get<std::string>());
    methods += method.at("name").get<std::string>() + ",";
  }
  for (const auto& family : names.at("families"))
    methods += "learned:" + family.at("name").get<std::string>() + ",";
  methods.pop_back();
  const auto all = cited(folder, "--methods " + methods);
  BOOST_TEST(std::ranges::includes(all, sources));
  for (const auto& system : names.at("systems")) {
    BOOST_TEST(run(folder, "cite --system " + system.at("name").get<std::string>()).code == 0);
  }
}

BOOST_AUTO_TEST_CASE(what_is_printed_is_bibtex) {
  const scratch folder("cite_bibtex");
  const auto text = run(folder, "cite --methods pefrl --metric acf").out;
  BOOST_TEST(std::ranges::count(text, '{') == std::ranges::count(text, '}'));
  BOOST_TEST(std::ranges::count(text, '@') == 6);  // nysalt, the paper, pefrl, acf, the reference, Eigen
  BOOST_TEST(text.find("% for pefrl\n@article{omelyan_mryglod_folk_2002,\n") != std::string::npos, text);
  const std::string told = run(folder, "--version").out;  // nysalt 1.2.3
  const std::string version = told.substr(told.find(' ') + 1, told.find('\n') - told.find(' ') - 1);
  BOOST_TEST(text.find("version " + version + "}") != std::string::npos, text);
}

BOOST_AUTO_TEST_CASE(files_know_what_they_were_made_with) {
  const scratch folder("cite_files");
  const auto make = [&](const std::string& line) { BOOST_TEST_REQUIRE(run(folder, line).code == 0, line); };
  const auto of_scheme =
      with(random_numbers, {"hairer_lubich_wanner_2006", "okunbor_skeel_1992", "ceres", "blanes_moan_2002"});
  make("learn --family nystrom --system fpu --step 0.03 --trajectories 10 --output scheme.json");
  BOOST_TEST((cited(folder, "scheme.json") == of_scheme));
  BOOST_TEST((cited(folder, "manifest.json") == of_scheme));
  BOOST_TEST((cited(folder, "--methods scheme.json") == of_scheme));

  const std::string running = "run --step 0.03 --horizon 0.3 ";
  make(running + "--system phi4 --method pefrl --friction 1 --sigma 1 --output bath.csv");
  BOOST_TEST((
      cited(folder, "bath.csv") ==
      with(random_numbers, {"aoki_kusnezov_2002", "omelyan_mryglod_folk_2002", "leimkuhler_matthews_2015"})));
  make(running + "--system phi4 --method verlet --friction 0 --sigma 0 --output still.csv");  // no bath
  BOOST_TEST((cited(folder, "still.csv") == with(random_numbers, {"aoki_kusnezov_2002", "verlet_1967"})));

  make("compare --system fpu --methods verlet,scheme.json --steps 0.03 --trajectories 8 --output report");
  BOOST_TEST((cited(folder, "report") == with(of_scheme, {"verlet_1967"})));
  BOOST_TEST((cited(folder, "report/rows.csv") == with(of_scheme, {"verlet_1967"})));
  make("stability --family fg_chin --parameters 0.18,0.012 --output trace.csv");
  BOOST_TEST((cited(folder, "trace.csv") == with({"chin_1997"})));

  // From elsewhere schemes are looked for beside the result.
  make(running + "--system fpu --method scheme.json --output out.csv");
  const auto above = shell(folder, "mkdir above; cd above; \"$nysalt\" cite --json ../out.csv");
  BOOST_TEST((keys(above) == of_scheme));
  BOOST_TEST_REQUIRE(shell(folder, "mv scheme.json verlet").code == 0);
  BOOST_TEST((cited(folder, "verlet") == of_scheme));  // a file, and one that needs no manifest
  BOOST_TEST((cited(folder, "--methods verlet") == with({"verlet_1967"})));
  must_be_told(folder, "out.csv", "manifest.json, out.csv: ");  // as its scheme is gone
  // Of the whole folder the rest is cited, and what is left out is said.
  const auto rest = run(folder, "cite --json manifest.json");
  BOOST_TEST(rest.err.find("manifest.json, out.csv: ") != std::string::npos, rest.err);
  BOOST_TEST(rest.err.find("left out") != std::string::npos, rest.err);
  BOOST_TEST(keys(rest).contains("aoki_kusnezov_2002"));
}

BOOST_AUTO_TEST_CASE(entries_of_other_commands_hide_no_others) {
  const scratch folder("cite_others");
  const auto entry = [](const std::string& options) {
    return json{{"command", "nysalt"}, {"options", options}, {"versions", json::object()}};
  };
  BOOST_TEST_REQUIRE(
      run(folder, "run --system phi4 --method pefrl --step 0.03 --horizon 0.3 --output new.csv").code == 0);
  json manifest = json::parse(contents(folder / "manifest.json"));
  manifest["files"]["draws.csv"] = entry("sample.system=phi4");
  std::ofstream(folder / "manifest.json") << manifest;
  const auto done = run(folder, "cite --json manifest.json");
  BOOST_TEST((keys(done) == with(random_numbers, {"aoki_kusnezov_2002", "omelyan_mryglod_folk_2002"})));
  BOOST_TEST(done.err.find("draws.csv") != std::string::npos, done.err);
  must_be_told(folder, "draws.csv",
               "draws.csv: the command must be one of learn, run, compare, recommend, stability, export, got "
               "'sample'");
  manifest["files"].erase("new.csv");
  std::ofstream(folder / "manifest.json") << manifest;
  must_be_told(folder, "manifest.json",
               "draws.csv: the command must be one of learn, run, compare, recommend, stability, export, got "
               "'sample'");  // nothing is left
}

// FILE.manifest.json, of one file.
BOOST_AUTO_TEST_CASE(manifests_of_earlier_versions_are_read_where_there_is_no_entry) {
  const scratch folder("cite_earlier");
  const auto earlier = [&](const std::string& file, const std::string& method) {
    std::ofstream(folder / (file + ".manifest.json"))
        << json{{"file", file},
                {"command", "nysalt"},
                {"options", "run.system=phi4\nrun.method=" + method},
                {"versions", json::object()}};
  };
  earlier("old.csv", "pefrl");
  const auto of_pefrl = with(random_numbers, {"aoki_kusnezov_2002", "omelyan_mryglod_folk_2002"});
  BOOST_TEST((cited(folder, "old.csv") == of_pefrl));
  BOOST_TEST((cited(folder, "old.csv.manifest.json") == of_pefrl));
  BOOST_TEST_REQUIRE(
      run(folder, "run --system phi4 --method verlet --step 0.03 --horizon 0.3 --output new.csv").code == 0);
  BOOST_TEST((cited(folder, "old.csv") == of_pefrl));  // the manifest of the folder says nothing of it
  earlier("new.csv", "pefrl");
  const auto of_verlet = with(random_numbers, {"aoki_kusnezov_2002", "verlet_1967"});
  BOOST_TEST((cited(folder, "new.csv") == of_verlet));
  BOOST_TEST((cited(folder, "manifest.json") == of_verlet));
  // What is written anew is no longer what the earlier one says.
  BOOST_TEST_REQUIRE(
      run(folder, "run --system phi4 --method verlet --step 0.03 --horizon 0.3 --output old.csv").code == 0);
  BOOST_TEST(!folder.files().contains("old.csv.manifest.json"));
  BOOST_TEST((cited(folder, "old.csv") == of_verlet));
}

BOOST_AUTO_TEST_CASE(a_recommendation_cites_its_winner_and_its_rivals) {
  const scratch folder("cite_recommendation");
  const std::string asked = "recommend --system henon_heiles --budget 5 --horizon 20 --trajectories 50 ";
  BOOST_TEST_REQUIRE(run(folder, asked + "--families bab6 --output best.json").code == 0);
  const auto works = cited(folder, "best.json");
  for (const char* key : {"chin_1997", "ceres", "verlet_1967", "blanes_moan_2002"})
    BOOST_TEST(works.contains(key));
  BOOST_TEST(!works.contains("okunbor_skeel_1992"));  // of a family that was not asked for
}

BOOST_AUTO_TEST_CASE(what_is_not_known_is_told) {
  const scratch folder("cite_refusals");
  must_be_told(folder, "--methods leapfrog", "unknown method 'leapfrog'");
  must_be_told(folder, "--methods learned:verlet", "unknown family 'verlet'");
  must_be_told(folder, "--methods verlet@above", "unknown placement 'above'");
  must_be_told(folder, "--system earth", "unknown system 'earth'");
  must_be_told(folder, "--metric taste", "unknown metric 'taste'");
  must_be_told(folder, "gone.json", "cannot read gone.json: there is no such file");
  BOOST_TEST_REQUIRE(shell(folder, "echo '{}' > odd.manifest.json").code == 0);
  must_be_told(folder, "odd.manifest.json", "the entry must be that of a manifest of nysalt");
  BOOST_TEST_REQUIRE(shell(folder, "mkdir folder folder.manifest.json").code == 0);
  must_be_told(folder, "folder", "folder: there is no such file, and no report in a folder");
  must_be_told(folder, std::string(5000, 'a'), "there is no such file");
  BOOST_TEST_REQUIRE(shell(folder, "echo '{\"options\": \"run.system=earth\"}' > earth.manifest.json").code ==
                     0);
  must_be_told(folder, "earth.manifest.json", "earth.manifest.json, earth: unknown system 'earth'");
  BOOST_TEST_REQUIRE(shell(folder, "echo '{}' > odd.json").code == 0);
  must_be_told(folder, "odd.json", "neither a scheme nor a table");
}
