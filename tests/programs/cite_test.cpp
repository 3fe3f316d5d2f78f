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
  for (const auto& work : json_of(done).at("references")) {
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

std::set<std::string> with(std::set<std::string> more) {
  more.insert(always.begin(), always.end());
  return more;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_part_of_a_setup_has_its_works) {
  const scratch folder("cite_parts");
  BOOST_TEST((cited(folder, "") == always));
  BOOST_TEST((cited(folder, "--system pendulum --methods verlet") == with({"verlet_1967"})));
  BOOST_TEST((
      cited(folder, "--system henon_heiles --methods srkn6b,s_aia2") ==
      with({"henon_heiles_1964", "blanes_moan_2002", "nagar_fernandez_pendas_sanz_serna_akhmatskaya_2024"})));
  BOOST_TEST((cited(folder, "--methods learned:nystrom") ==
              with({"okunbor_skeel_1992", "ceres", "blanes_moan_2002"})));
  BOOST_TEST((cited(folder, "--system pendulum --bath --methods learned:fg_chin@symmetric") ==
              with({"chin_1997", "ceres", "leimkuhler_matthews_2013", "leimkuhler_matthews_2015",
                    "salmon_2011", "box_muller_1958"})));
  BOOST_TEST((cited(folder, "--methods verlet --metric acceptance,path:q1") ==
              with({"verlet_1967", "duane_kennedy_pendleton_roweth_1987", "blanes_moan_2002"})));
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
  const auto text = run(folder, "cite --system phi4 --methods srkn6b").out;
  BOOST_TEST(std::ranges::count(text, '{') == std::ranges::count(text, '}'));
  BOOST_TEST(std::ranges::count(text, '@') == 5);  // nysalt, the paper, phi4, srkn6b, Eigen
  BOOST_TEST(text.find("% for the system phi4\n@article{aoki_kusnezov_2002,\n") != std::string::npos, text);
  const std::string told = run(folder, "--version").out;  // nysalt 1.2.3
  const std::string version = told.substr(told.find(' ') + 1, told.find('\n') - told.find(' ') - 1);
  BOOST_TEST(text.find("version " + version + "}") != std::string::npos, text);
}

BOOST_AUTO_TEST_CASE(files_know_what_they_were_made_with) {
  const scratch folder("cite_files");
  const std::string learning = "learn --system fpu --step 0.03 --trajectories 10 --output scheme.json";
  BOOST_TEST_REQUIRE(run(folder, learning).code == 0);
  const auto of_scheme =
      with({"hairer_lubich_wanner_2006", "okunbor_skeel_1992", "ceres", "blanes_moan_2002"});
  BOOST_TEST((cited(folder, "scheme.json") == of_scheme));
  BOOST_TEST((cited(folder, "scheme.json.manifest.json") == of_scheme));
  BOOST_TEST((cited(folder, "--methods scheme.json") == of_scheme));
  const std::string running =
      "run --system phi4 --method pefrl --step 0.01 --horizon 0.1 --friction 1 --sigma 1 --output out.csv";
  BOOST_TEST_REQUIRE(run(folder, running).code == 0);
  BOOST_TEST(
      (cited(folder, "out.csv") == with({"aoki_kusnezov_2002", "omelyan_mryglod_folk_2002",
                                         "leimkuhler_matthews_2015", "salmon_2011", "box_muller_1958"})));
  BOOST_TEST_REQUIRE(shell(folder, "rm scheme.json.manifest.json").code == 0);
  BOOST_TEST((cited(folder, "scheme.json") == of_scheme));  // a scheme needs none
}

BOOST_AUTO_TEST_CASE(what_is_not_known_is_told) {
  const scratch folder("cite_refusals");
  must_be_told(folder, "--methods leapfrog", "unknown method 'leapfrog'");
  must_be_told(folder, "--methods learned:verlet", "unknown family 'verlet'");
  must_be_told(folder, "--methods verlet@above", "unknown placement 'above'");
  must_be_told(folder, "--system earth", "unknown system 'earth'");
  must_be_told(folder, "--metric taste", "unknown metric 'taste'");
  must_be_told(folder, "gone.json", "gone.json: there is no such file");
  BOOST_TEST_REQUIRE(shell(folder, "echo '{}' > odd.manifest.json").code == 0);
  must_be_told(folder, "odd.manifest.json", "not a manifest of nysalt");
  BOOST_TEST_REQUIRE(shell(folder, "mkdir folder folder.manifest.json").code == 0);
  must_be_told(folder, "folder", "cannot read folder");
  BOOST_TEST_REQUIRE(shell(folder, "echo '{}' > odd.json").code == 0);
  must_be_told(folder, "odd.json", "neither a scheme nor a table");
}
