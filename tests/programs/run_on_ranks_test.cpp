// SPDX-License-Identifier: BSL-1.0
// `mpirun nysalt run`: the bytes of one process, on any number of ranks and threads; a rank that dies ends
// the job, and another number of ranks goes on with it.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/killed.hpp"
#include "../support/mpirun.hpp"
#include "../support/program.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

// Noise, several blocks of lanes, the last of them not full.
std::string in_bath(const std::string& horizon) {
  return "run --system fpu --friction 0.01 --sigma 0.05 --method baoab --step 0.01 --trajectories 77 "
         "--observables stiff_energy,q1,p6 --sample-every 70 --horizon " +
         horizon + " ";
}
// Some of them diverge, at several steps.
const std::string with_losses =
    "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 600 --trajectories 90 "
    "--sample-every 7 ";

struct shared {
  int ranks;
  int threads;
};

std::string on(const shared& by) { return on_ranks(by.ranks); }
std::string threads(const shared& by) { return "--threads " + std::to_string(by.threads) + " "; }

/// The same output, and the same document but for times and the name of that.
void same_as_alone(const std::string& line, const std::string& kind, const std::vector<shared>& all) {
  const scratch folder("ranks");
  const auto alone = run(folder, line + "--threads 1 --json --output a" + kind);
  BOOST_TEST_REQUIRE(alone.code == 0, alone.err);
  const std::string expected = contents(folder / ("a" + kind));
  BOOST_TEST_REQUIRE(run(folder, line + "--seed 2 --output a" + kind).code == 0);
  BOOST_TEST((contents(folder / ("a" + kind)) != expected));  // so that the test can tell
  for (const auto& by : all) {
    std::filesystem::remove(folder / ("a" + kind));
    const auto result = shell(folder, on(by) + line + threads(by) + "--json --output a" + kind);
    BOOST_TEST_CONTEXT(line << kind << " on " << by.ranks << " ranks, " << by.threads << " threads") {
      BOOST_TEST_REQUIRE(result.code == 0, result.err);
      BOOST_TEST((contents(folder / ("a" + kind)) == expected));
      BOOST_TEST(without_times(result.out) == without_times(alone.out));
    }
  }
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

void refused_once(const scratch& folder, const std::string& line, const std::string& why) {
  const auto before = folder.files();
  const auto result = shell(folder, line);
  BOOST_TEST(result.code == 2, line << " ended with " << result.code);
  BOOST_TEST(count(result.err, why) == 1U, line << " said " << result.err);
  BOOST_TEST(count(result.err, "nysalt: ") == 1U, line << " said " << result.err);
  BOOST_TEST((folder.files() == before), line << " left something");
}

}  // namespace

BOOST_AUTO_TEST_CASE(ranks_and_threads_change_no_byte) {
  same_as_alone(in_bath("20"), ".csv", {{1, 2}, {2, 1}, {3, 2}});
  same_as_alone(with_losses, ".csv", {{2, 2}, {3, 1}});
  same_as_alone(with_losses, ".npy", {{2, 1}});
#if defined NYSALT_HAS_HDF5
  same_as_alone(in_bath("20"), ".h5", {{3, 1}});
  same_as_alone(with_losses, ".h5", {{2, 2}});
#endif
}

BOOST_AUTO_TEST_CASE(ranks_without_a_trajectory_do_no_harm) {
  const std::string two =
      "run --system pendulum --method srkn6b --step 0.1 --horizon 400 --sample-every 10 --trajectories 2 ";
  const scratch folder("ranks_idle");
  const auto alone = run(folder, two);
  const auto shared = run_on(3, folder, two);
  BOOST_TEST(shared.code == 0, shared.err);
  BOOST_TEST(alone.out.size() > 1000U);
  BOOST_TEST((shared.out == alone.out));
}

// Fewer trajectories than ranks of a local system: all ranks share the sites of each. Words that keep a force
// and words that keep none, a ring of rows, one trajectory that diverges.
BOOST_AUTO_TEST_CASE(ranks_that_share_the_sites_of_a_trajectory_change_no_byte) {
  const std::string chain =
      "run --system fpu --pairs 6000 --step 0.01 --horizon 3 --observables energy,q1,p6001,q12000 ";
  same_as_alone(chain + "--method verlet --sample-every 7 ", ".csv", {{2, 2}, {3, 1}, {4, 1}});
  same_as_alone(chain + "--method pefrl --sample-every 100 --trajectories 2 ", ".npy", {{3, 1}});
  same_as_alone(
      "run --system phi4_lattice --side 96 --step 0.05 --horizon 10 --method srkn6b --sample-every 50 ",
      ".csv", {{2, 1}, {4, 1}});
  const scratch folder("ranks_sites_lost");
  const std::string lost =
      "run --system fpu --pairs 6000 --method verlet --step 0.0399 --horizon 40 --sample-every 1 "
      "--trajectories 2 "
      "--output ";
  const auto alone = run(folder, lost + "a.csv");
  const auto shared = run_on(3, folder, lost + "b.csv");
  BOOST_TEST(alone.code == 3, alone.err);
  BOOST_TEST(shared.code == 3, shared.err);
  BOOST_TEST((contents(folder / "a.csv") == contents(folder / "b.csv")));
  const std::string first_lost = alone.err.substr(alone.err.find("trajectory 0 diverged at step"));
  BOOST_TEST(shared.err.find(first_lost.substr(0, first_lost.find(','))) != std::string::npos, shared.err);
}

// One rank goes on with what three had saved, and three with what one had; the words keep a force.
BOOST_AUTO_TEST_CASE(sites_that_ranks_shared_are_resumed_by_others) {
  for (const bool from_ranks : {true, false}) {
    const scratch folder("ranks_sites_resumed");
    const std::string line =
        "run --system fpu --pairs 6000 --method verlet --step 0.01 --horizon 160 --sample-every 64 "
        "--observables "
        "energy,q1,p12000 --trajectories 2 ";
    const auto whole = run(folder, line + "--output whole.csv");
    BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
    const std::string command = line + "--output a.csv --checkpoint a.checkpoint --threads 1 --every ";
    const std::string begun = from_ranks ? on_ranks(3) : "\"$nysalt\" ";
    const auto stopped = shell(folder, begun + command + "64 >/dev/null 2>&1 & pid=$!\n" +
                                           wait_for("a.checkpoint", 500) + "kill -TERM $pid; ! wait $pid");
    BOOST_TEST(stopped.code == 0, stopped.err);
    BOOST_TEST_REQUIRE(
        std::filesystem::exists(folder / "a.csv.part"));  // so that there is something to resume
    const auto resumed =
        from_ranks ? run(folder, command + "64000 --resume") : run_on(3, folder, command + "64000 --resume");
    BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / "a.csv") == contents(folder / "whole.csv")));
  }
}

BOOST_AUTO_TEST_CASE(ranks_may_have_other_threads_and_nothing_else) {
  const scratch folder("ranks_unlike");
  const auto alone = run(folder, in_bath("20") + "--output a.csv");
  BOOST_TEST_REQUIRE(alone.code == 0, alone.err);
  const auto unlike = [&](const std::string& option, const std::string& output) {
    return shell(folder, mpirun(2) + "sh -c 'exec \"$nysalt\" " + in_bath("20") + option +
                             "$((3 - 2*OMPI_COMM_WORLD_RANK)) --output " + output + "'");
  };
  const auto threads = unlike("--threads ", "b.csv");
  BOOST_TEST(threads.code == 0, threads.err);
  BOOST_TEST((contents(folder / "b.csv") == contents(folder / "a.csv")));
  const auto seeds = unlike("--seed ", "c.csv");
  BOOST_TEST(seeds.code == 2);
  BOOST_TEST(count(seeds.err, "rank 1 must have the options of rank 0") == 1U, seeds.err);
  BOOST_TEST(!std::filesystem::exists(folder / "c.csv"));
}

BOOST_AUTO_TEST_CASE(a_rank_that_dies_ends_the_job_and_others_go_on_with_it) {
  for (const std::string kind : {".csv", ".npy"}) {
    const scratch folder("ranks_killed");
    const std::string line = in_bath("400");
    const auto whole = run(folder, line + "--output whole" + kind);
    BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
    const std::string command =
        line + "--output a" + kind + " --checkpoint a.checkpoint --threads 1 --every ";
    const auto killed =
        shell(folder, on_known_ranks(3, command + "100") + " >/dev/null 2>&1 & pid=$!\n" +
                          wait_for("a.checkpoint", 500) + "kill -9 $(cat pid.2) && ! wait $pid");
    BOOST_TEST(killed.code == 0, killed.err);
    BOOST_TEST(std::filesystem::exists(folder / ("a" + kind + ".part")));
    const auto resumed = kind == ".csv" ? run(folder, command + "5000 --resume")
                                        : run_on(2, folder, command + "5000 --resume");
    BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / ("a" + kind)) == contents(folder / ("whole" + kind))));
  }
}

// A batch system may warn any of the ranks, or all.
BOOST_AUTO_TEST_CASE(a_signal_to_any_rank_makes_a_checkpoint) {
  const scratch folder("ranks_signalled");
  const std::string line = in_bath("4000");
  const auto whole = run(folder, line + "--output whole.csv");
  BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
  const std::string command = line + "--output a.csv --checkpoint a.checkpoint --threads 1 --every 20000";
  for (const std::string to : {"pid.0", "pid.1", "pid.0 pid.1"}) {
    const auto done =
        shell(folder, "rm -f a.* pid.*; " + on_known_ranks(2, command) + " >/dev/null 2>err & pid=$!\n" +
                          wait_for("a.checkpoint", 1) + "kill -USR1 $(cat " + to + "); wait $pid; echo $?");
    const std::string err = contents(folder / "err");
    BOOST_TEST(done.out == "138\n", to << ": " << done.out << err);
    BOOST_TEST(count(err, "signal 10 ended it; take --resume") == 1U, err);
    const auto resumed = run(folder, command + " --resume");
    BOOST_TEST(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / "a.csv") == contents(folder / "whole.csv")));
  }
}

// One of them makes the file; the others do not find it in their way.
BOOST_AUTO_TEST_CASE(a_new_system_is_made_once) {
  const scratch folder("ranks_new");
  const auto done = run_on(3, folder, "new mine");
  BOOST_TEST(done.code == 0, done.err);
  BOOST_TEST(done.err == "");
  BOOST_TEST(std::filesystem::exists(folder / "mine.hpp"));
}

BOOST_AUTO_TEST_CASE(bad_input_is_told_once_and_all_know_that_all_diverged) {
  const scratch folder("ranks_refused");
  refused_once(folder, on_ranks(3) + in_bath("20") + "--output none/a.csv", "there is no folder none");
  refused_once(folder, on_ranks(3) + "run --method mine.json --step 0.1 --horizon 1 --output a.csv",
               "mine.json");
  // Found out in the midst, by rank 0 alone: its folder has another name.
  const std::string command = in_bath("400") + "--output d/a.csv --checkpoint d/c --every 100";
  const auto done = shell(folder, "mkdir d\n" + on_ranks(2) + command + " & pid=$!\n" + wait_for("d/c", 500) +
                                      "mv d e; wait $pid");
  BOOST_TEST(done.code == 4, done.err);
  BOOST_TEST(count(done.err, "nysalt: cannot write d/c") == 1U, done.err);
  const auto lost = run_on(2, folder,
                           "run --system henon_heiles --spread 50 --method verlet --step 0.3 --horizon 600 "
                           "--trajectories 40 --output a.csv");
  BOOST_TEST(lost.code == 3, lost.err);
}
