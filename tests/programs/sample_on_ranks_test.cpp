// SPDX-License-Identifier: BSL-1.0
// `mpirun nysalt sample`: the bytes of one process, on any number of ranks and threads; another number of
// ranks goes on with what was killed.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

#include "../support/mpirun.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

// Three leaves of chains, the last of them not full.
const std::string line =
    "sample --system phi4 --masses 5 --length 1 --chains 37 --burn-in 200 --draws 300 --diagonal-masses "
    "--json "
    "--output out.csv ";

/// What the program itself says on standard error: mpiexec adds lines of its own.
std::string said(const std::string& err) {
  std::istringstream lines(err);
  std::string result;
  for (std::string one; std::getline(lines, one);) {
    if (one.starts_with("nysalt: ")) result += one + '\n';
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(ranks_change_no_byte) {
  const scratch folder("sample_ranks");
  const auto alone = run(folder, line + "--threads 1");
  BOOST_TEST_REQUIRE(alone.code == 0, alone.err);
  const std::string expected = contents(folder / "out.csv");
  for (const int ranks : {2, 3}) {
    std::filesystem::remove(folder / "out.csv");
    const auto shared = run_on(ranks, folder, line + "--threads 2");
    BOOST_TEST_REQUIRE(shared.code == 0, shared.err);
    BOOST_TEST((contents(folder / "out.csv") == expected));
    BOOST_TEST(shared.out == alone.out);
  }
  BOOST_TEST_REQUIRE(run(folder, line + "--seed 2").code == 0);
  BOOST_TEST((contents(folder / "out.csv") != expected));  // so that the test can tell
}

BOOST_AUTO_TEST_CASE(more_ranks_go_on_with_what_was_killed) {
  const scratch folder("sample_ranks_killed");
  const auto whole = run(folder, line);
  BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
  const std::string expected = contents(folder / "out.csv");
  std::filesystem::remove(folder / "out.csv");
  const std::string checkpointed = line + "--checkpoint c --every 10 ";
  const auto killed = shell(folder, "\"$nysalt\" " + checkpointed + ">/dev/null 2>&1 & pid=$!\n" +
                                        "while [ ! -f c ]; do sleep .01; done; kill -9 $pid && ! wait $pid");
  BOOST_TEST_REQUIRE(killed.code == 0, "it ended before it could be killed: " << killed.err);
  const auto other = run_on(2, folder, checkpointed + "--resume --seed 2");
  BOOST_TEST(other.code == 2);
  BOOST_TEST(said(other.err) ==
             "nysalt: c must be a checkpoint of this run, got that of another run (seed); ask for the same, "
             "or name another --checkpoint\n");
  const auto resumed = run_on(3, folder, checkpointed + "--resume");
  BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
  BOOST_TEST((contents(folder / "out.csv") == expected));
  BOOST_TEST(resumed.out == whole.out);
}

BOOST_AUTO_TEST_CASE(what_is_refused_is_one_line_on_ranks_too) {
  const scratch folder("sample_ranks_bad");
  for (const std::string& bad : {std::string("--system pendulum --length 0"), std::string("--system nothing"),
                                 std::string("--system pendulum --length 1 --resume")}) {
    const auto done = run_on(2, folder, "sample " + bad);
    BOOST_TEST(done.code == 2);
    const std::string message = said(done.err);
    BOOST_TEST(std::ranges::count(message, '\n') == 1, done.err);
  }
}
