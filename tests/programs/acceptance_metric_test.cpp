// SPDX-License-Identifier: BSL-1.0
// compare --metric acceptance: the library's numbers, under their own name, where they can be.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../../src/comparison/seeds.hpp"
#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/without_times.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const std::string line = "compare --methods verlet,learned:fg_chin --steps 0.03 --metric acceptance ";
const std::string few = line + "--trajectories 20 --learn-trajectories 5 ";

}  // namespace

BOOST_AUTO_TEST_CASE(the_numbers_are_those_of_the_library) {
  const fpu_chain<3> chain(50.0);
  const fpu_law<3> law(chain);
  const trajectory_options options{
      .step = 0.03, .steps = 66, .trajectories = 20, .seed = program::seed_for(program::role::test, 5)};
  for (const double temperature : {1.0, 0.2}) {
    const auto all =
        document(few + "--seed 5 --horizon 2" + (temperature == 1.0 ? "" : " --hmc-temperature 0.2"));
    const auto& theta = all["fits"][0]["parameters"];
    const auto must_be = [&](const auto& row, const auto& method) {
      const auto expected = acceptance(chain, method, law, options, temperature);
      BOOST_TEST(row["acceptance"] == expected.probability.mean);
      BOOST_TEST(row["standard_error"] == expected.probability.standard_error);
      BOOST_TEST(row["evaluations_per_time"] == expected.evaluations_per_time);
      BOOST_TEST(row["diverged"] == 0);
      BOOST_TEST(!row.contains("error"));
      BOOST_TEST(expected.probability.mean < 1.0);
    };
    BOOST_TEST(all["hmc_temperature"] == temperature);
    must_be(all["rows"][0], verlet());
    must_be(all["rows"][1], member<fg_chin>({theta["b"], theta["c"]}));
  }
}

BOOST_AUTO_TEST_CASE(tables_and_pictures_are_of_acceptances) {
  const scratch folder("acceptance");
  const auto done = run(folder, few + "--equal-cost --output out");
  BOOST_TEST(done.code == 0);
  BOOST_TEST(done.out.find("acceptance at kT = 1") != std::string::npos);
  BOOST_TEST(done.out.find("its rejections / learned") != std::string::npos);
  const auto rows = contents(folder / "out/rows.csv");
  BOOST_TEST(rows.find("\nacceptance,") != std::string::npos);
  const auto script = contents(folder / "out/pictures/acceptance_against_evaluations.gp");
  BOOST_TEST(script.find("set logscale x\n") != std::string::npos);
  BOOST_TEST(script.find("logscale xy") == std::string::npos);
  BOOST_TEST(!contents(folder / "out/pictures/acceptance_against_seconds.svg").empty());
}

BOOST_AUTO_TEST_CASE(what_diverged_is_rejected_and_if_all_did_there_is_no_result) {
  const std::string unstable =
      "compare --methods verlet --steps 0.05 --metric acceptance --trajectories 40 --json --horizon ";
  const auto some = json_of(run(unstable + "0.15"))["rows"][0];
  BOOST_TEST(some["diverged"] > 0);
  BOOST_TEST(some["diverged"] < 40);
  BOOST_TEST(!some.contains("reason"));
  const auto done = run(unstable + "1");
  BOOST_TEST(done.code == 3);
  const auto none = json_of(done)["rows"][0];
  BOOST_TEST(none["acceptance"] == 0.0);
  BOOST_TEST(none["reason"].get<std::string>().find("every trajectory diverged") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(threads_change_no_byte) {
  const auto printed = [](const std::string& threads) {
    return without_times(run(few + "--json --threads " + threads).out);
  };
  const auto one = printed("1");
  BOOST_TEST(one.size() > 500U);
  BOOST_TEST(printed("3") == one);
}

BOOST_AUTO_TEST_CASE(what_is_no_proposal_is_refused) {
  all_refused(scratch("acceptance_refused"),
              {{"compare --steps 0.1 --metric acceptance --methods learned:aba3_free",
                {"learned:aba3_free", "must be reversible", "symmetric"}},
               {line + "--friction 1 --temperature 1", {"acceptance", "bath", "--friction"}},
               {line + "--hmc-temperature 0", {"--hmc-temperature", "positive", "0"}},
               {line + "--hmc-temperature nan", {"--hmc-temperature", "finite"}},
               {line + "--observable energy", {"--observable", "got acceptance"}},
               {"compare --methods verlet --steps 0.1 --metric path --hmc-temperature 2",
                {"--hmc-temperature", "acceptance", "got path"}}});
}
