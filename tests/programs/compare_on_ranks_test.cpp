// SPDX-License-Identifier: BSL-1.0
// What is compared by several ranks is what one process finds; it is said once, and all end alike.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "../support/mpirun.hpp"
#include "../support/program.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

/// With a learned family.
const std::string line =
    "compare --system pendulum --methods verlet,learned:fg_chin --steps 0.3,0.5 --horizon 30 "
    "--trajectories 70 --learn-trajectories 16 --learn-horizon 4 --metric ";
const std::string of_every_kind = line + "path,distribution:q1,acf:q1,acceptance --json ";
const std::string along_paths = line + "path,acceptance --output ";

std::string rows(const scratch& folder, const std::string& name) {
  return without_times_in_csv(contents(folder / (name + "/rows.csv")));
}
std::string report(const scratch& folder, const std::string& name) {
  return without_times(contents(folder / (name + "/report.json")));
}

std::size_t count(std::string_view text, std::string_view word) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string_view::npos; ++at) ++found;
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(ranks_and_threads_change_no_byte) {
  const scratch folder("compare_on_ranks");
  const auto alone = run(folder, of_every_kind + "--threads 1");
  BOOST_TEST_REQUIRE(alone.code == 0, alone.err);
  BOOST_TEST(json_of(alone)["rows"].size() == 16U);
  for (const auto& [ranks, threads] : {std::pair{1, 2}, {2, 1}, {2, 2}, {3, 1}, {3, 2}}) {
    const auto done = run_on(ranks, folder, of_every_kind + "--threads " + std::to_string(threads));
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    BOOST_TEST((without_times(done.out) == without_times(alone.out)), ranks << " ranks, " << threads);
  }
  const auto other = run(folder, of_every_kind + "--seed 2");
  BOOST_TEST((without_times(other.out) != without_times(alone.out)));
}

// Rank 1 of two is killed when half of the parts are there. Reports are those of one process, too.
BOOST_AUTO_TEST_CASE(a_killed_run_goes_on_with_other_ranks_to_the_same_bytes) {
  const scratch folder("compare_killed");
  BOOST_TEST_REQUIRE(run(folder, along_paths + "whole").code == 0);
  std::string killed = on_known_ranks(2, along_paths + "killed") + " >/dev/null 2>&1 & all=$!\n";
  killed += "while kill -0 $all 2>/dev/null && ";
  killed += "[ \"$(cat killed/journal.jsonl 2>/dev/null | wc -l)\" -lt 4 ]; do sleep .01; done\n";
  killed += "kill -9 $(cat pid.1); wait $all; echo $?; cp -r killed alone";
  const auto done = shell(folder, killed);
  BOOST_TEST(done.code == 0, done.err);
  BOOST_TEST(done.out != "0\n");  // one that dies ends all
  BOOST_TEST_REQUIRE(std::filesystem::exists(folder / "killed/journal.jsonl"));
  const auto refused = run_on(2, folder, along_paths + "killed");
  BOOST_TEST(refused.code == 2);
  BOOST_TEST(count(refused.err, "take --resume") == 1U, refused.err);
  const auto again = run_on(3, folder, along_paths + "killed --resume");
  BOOST_TEST_REQUIRE(again.code == 0, again.err);
  BOOST_TEST(count(again.err, "were taken from the journal") == 1U, again.err);
  BOOST_TEST_REQUIRE(run(folder, along_paths + "alone --resume").code == 0);
  for (const char* name : {"killed", "alone"}) {
    BOOST_TEST((rows(folder, name) == rows(folder, "whole")));
    BOOST_TEST((report(folder, name) == report(folder, "whole")));
    BOOST_TEST(!std::filesystem::exists(folder / (std::string(name) + "/journal.jsonl")));
  }
  const auto finished = run_on(2, folder, along_paths + "killed --resume");
  BOOST_TEST(finished.code == 0);
  BOOST_TEST(finished.out == "It is finished: killed\n");
}

BOOST_AUTO_TEST_CASE(bad_input_is_told_once) {
  const scratch folder("compare_bad_input");
  std::ofstream(folder / "file") << "no folder\n";
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const auto done = run_on(3, folder, arguments);
    BOOST_TEST(done.code == 2, arguments << " ended with " << done.code);
    BOOST_TEST(count(done.err, why) == 1U, done.err);
    BOOST_TEST(count(done.err, "nysalt: ") == 1U, done.err);
  };
  refused("compare --methods nobody --steps 0.02", "nobody");
  refused(along_paths + "file/report", "is not a folder");  // which rank 0 alone looks for
  refused("stability --method verlet --output file/curve.csv", "there is no folder");
  BOOST_TEST(folder.files().size() == 1U);
}

// Ranks leave no trace in what is printed and written.
BOOST_AUTO_TEST_CASE(all_other_commands_are_done_once) {
  const scratch folder("others_on_ranks");
  for (const std::string arguments : {"list", "stability --method verlet --output curve.csv",
                                      "recommend --system oscillator --omega 1 --budget 4 --horizon 20 "
                                      "--trajectories 40 --families nystrom "
                                      "--learn-trajectories 16 --output scheme.json --json"}) {
    const auto alone = run(folder, arguments);
    BOOST_TEST_REQUIRE(alone.code == 0, alone.err);
    const auto files = folder.files();
    std::string curve;
    if (files.contains("curve.csv")) curve = contents(folder / "curve.csv");
    const auto done = run_on(2, folder, arguments);
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST((without_times(done.out) == without_times(alone.out)), arguments << " said " << done.out);
    BOOST_TEST((folder.files() == files));
    if (!curve.empty()) BOOST_TEST((contents(folder / "curve.csv") == curve));
  }
}
