// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo in the program: what it draws, and that chains which were killed go on.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "../support/program.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {
const std::string gaussian = "sample --system linear_chain --masses 3 --spring 4 --method bcss3 --length 1 ";
}  // namespace

// Springs k between walls: V = k/2 q.(2 on the diagonal, -1 beside it).q, so that <q_2^2> = kT (1/k).
BOOST_AUTO_TEST_CASE(draws_have_the_law_and_chains_agree) {
  const scratch folder("sample");
  const json found = json_of(run(folder, gaussian + "--draws 2000 --json --output draws.csv"));
  BOOST_TEST(found["converged"] == true);
  BOOST_TEST(std::abs(found["acceptance"].get<double>() - 0.9) < 0.1);
  BOOST_TEST(found["diverged"] == 0);
  const json& scalars = found["scalars"];
  BOOST_TEST_REQUIRE(scalars.size() == 4U);
  const double mean = scalars[0]["mean"];
  // <V> = 3 kT/2, by equipartition; 4 standard errors.
  BOOST_TEST(std::abs(mean - 1.5) <= 4.0 * scalars[0]["standard_error"].get<double>());
  const double deviation = scalars[2]["deviation"];
  BOOST_TEST(std::abs(deviation * deviation - 0.25) < 0.02);
  const std::string draws = contents(folder / "draws.csv");
  BOOST_TEST(draws.starts_with("chain,draw,potential,q1,q2,q3\n0,0,"));
  BOOST_TEST(std::count(draws.begin(), draws.end(), '\n') == 1 + 4 * 2000);
  BOOST_TEST(recorded(folder / "draws.csv").dump().find("sample") != std::string::npos);
}

// Killed without warning once there is a checkpoint, in the burn-in or after it.
BOOST_AUTO_TEST_CASE(killed_chains_go_on_to_the_same_bytes) {
  const scratch folder("sample_killed");
  const std::string line =
      "sample --system phi4_lattice --side 20 --length 0.5 --burn-in 300 --draws 300 --chains 2 --json ";
  const auto whole = run(folder, line + "--output whole.csv");
  BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
  for (const int trajectories : {50, 350}) {
    const std::string checkpointed = line + "--output cut.csv --checkpoint cut.checkpoint --every 50 ";
    const std::string wait = fmt::format(
        "while kill -0 $pid 2>/dev/null; do n=\"$(head -n 1 cut.checkpoint 2>/dev/null | "
        "sed -n 's/.*\"trajectories\":\\([0-9]*\\).*/\\1/p')\"; [ \"${{n:-0}}\" -ge {} ] && break; sleep "
        ".01; "
        "done\n",
        trajectories);
    const auto killed = shell(folder, "\"$nysalt\" " + checkpointed + " >/dev/null 2>&1 & pid=$!\n" + wait +
                                          "kill -9 $pid && ! wait $pid");
    BOOST_TEST_REQUIRE(killed.code == 0, "it ended before it could be killed: " << killed.err);
    all_refused(folder, {{checkpointed, {"--resume"}},
                         {checkpointed + "--resume --seed 2", {"another run (seed)"}},
                         {checkpointed + "--resume --draws 200", {"draws"}},
                         {"run --method verlet --step 0.1 --horizon 1 --output cut.csv --every 5 --resume "
                          "--checkpoint cut.checkpoint",
                          {"must be a checkpoint of nysalt run, got sample"}}});
    const auto resumed = run(folder, checkpointed + "--resume --threads 2");
    BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / "cut.csv") == contents(folder / "whole.csv")));
    json expected = json_of(whole);
    json found = json_of(resumed);
    for (json* document : {&expected, &found}) document->erase("output");
    BOOST_TEST(found == expected);
    all_refused(folder, {{checkpointed + "--resume", {"there is no such checkpoint"}}});
  }
}

BOOST_AUTO_TEST_CASE(a_damaged_checkpoint_is_refused) {
  const scratch folder("sample_damaged");
  const std::string line =
      "sample --system pendulum --length 1 --draws 100000 --output o\xff.csv --checkpoint c --every 100 ";
  const auto killed =
      shell(folder, "\"$nysalt\" " + line + " >/dev/null 2>&1 & pid=$!\n" +
                        "while [ ! -f c ]; do sleep .01; done; kill -9 $pid; wait $pid; [ -f c ]");
  BOOST_TEST_REQUIRE(killed.code == 0, killed.err);
  std::string text = contents(folder / "c");
  char& of_first_number = text[text.find('\n') + 1];
  of_first_number = static_cast<char>(of_first_number ^ 1);
  std::ofstream(folder / "c", std::ios::binary) << text;
  all_refused(folder, {{line + "--resume", {"not whole, or was edited"}}});
}

BOOST_AUTO_TEST_CASE(sample) { run_table("sample"); }
