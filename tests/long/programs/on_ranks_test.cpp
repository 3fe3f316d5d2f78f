// SPDX-License-Identifier: BSL-1.0
// `mpirun nysalt`: the bytes of one process on any number of ranks and threads; what is wrong is said once; a
// rank that dies or is signalled ends the job, and another number of ranks goes on with it. In tier 1:
// smoke/on_ranks_test.cpp.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../../support/mpirun.hpp"
#include "../../support/stopping.hpp"

using namespace nysalt::test;

namespace {

// Noise, several blocks of lanes, the last of them not full.
std::string in_bath(const std::string& horizon) {
  return "run --system fpu --friction 0.01 --sigma 0.05 --start law --method baoab --step 0.01 "
         "--trajectories 77 "
         "--observables stiff_energy,q1,p6 --sample-every 70 --horizon " +
         horizon + " ";
}
// Some of them diverge, at several steps.
const std::string with_losses =
    "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 600 --trajectories 90 "
    "--sample-every 7";
const std::string compare =
    "compare --system pendulum --methods verlet,learned:fg_chin --steps 0.3,0.5 --horizon 10 --trajectories "
    "70 "
    "--learn-trajectories 16 --learn-horizon 4 --learn-effort quick --metric ";
const std::string learn = "learn --family nystrom --step 0.03 --effort quick --horizon 0.3 ";
const std::string sample =
    "sample --system phi4 --masses 5 --length 1 --chains 37 --burn-in 200 --draws 300 --diagonal-masses";
// Fewer trajectories than ranks of a local system: all ranks share the sites of each.
const std::string chain =
    "run --system fpu --pairs 6000 --step 0.01 --horizon 3 --observables energy,q1,p6001,q12000 --method ";

std::vector<shared_command> shared_commands() {
  std::vector<shared_command> all{
      {in_bath("20"), "a.csv", {{1, 2}, {2, 1}, {3, 2}}},
      {with_losses, "a.csv", {{2, 2}, {3, 1}}},
      {with_losses, "a.npy", {{2, 1}}},
      {"run --system pendulum --method srkn6b --step 0.1 --horizon 40 --trajectories 2",
       "",
       {{3, 1}}},  // one is idle
      // Words that keep a force and words that keep none, a ring of rows, a trajectory that diverges.
      {chain + "verlet --sample-every 7", "a.csv", {{2, 2}, {3, 1}, {4, 1}}},
      {chain + "pefrl --sample-every 100 --trajectories 2", "a.npy", {{3, 1}}},
      {"run --system phi4_lattice --side 96 --step 0.05 --horizon 10 --method srkn6b --sample-every 50",
       "a.csv",
       {{2, 1}, {4, 1}}},
      {"run --system fpu --pairs 6000 --method verlet --step 0.0399 --horizon 40 --trajectories 2",
       "a.csv",
       {{3, 1}},
       3},
      {compare + "path,distribution:q1,acf:q1,acceptance", "", {{1, 2}, {2, 1}, {3, 1}, {3, 2}}},
      {learn + "--fine-step 0.00025 --trajectories 330", "s.json", {{1, 2}, {2, 2}, {3, 1}}},
      {learn + "--fine-step 0.00025 --trajectories 330 --friction 1 --temperature 1 --start law",
       "s.json",
       {{3, 2}}},
      {learn + "--fine-step 0.001 --enough 5e-5",
       "s.json",
       {{3, 1}}},  // data that grow until they are enough
      {sample, "a.csv", {{2, 2}, {3, 2}}},
      {"recommend --system oscillator --omega 1 --budget 4 --horizon 20 --trajectories 40 --families nystrom "
       "--learn-trajectories 16",
       "s.json",
       {{2, 1}}}};
#if defined NYSALT_HAS_HDF5
  all.push_back({in_bath("20"), "a.h5", {{3, 1}}});
  all.push_back({with_losses, "a.h5", {{2, 2}}});
#endif
  return all;
}

/// Goes on with what was stopped, and comes to the result of a run that nothing happened to.
void goes_on(int ranks, const scratch& folder, const stoppable& one, const std::string& expected) {
  const auto resumed = run_on(ranks, folder, one.command() + " --resume");
  BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
  BOOST_TEST((result_in(folder, one.output) == expected), one.line);
}

/// What `nysalt` of one process makes.
std::string undisturbed(const stoppable& one) {
  const scratch folder("ranks_undisturbed");
  const auto done = run(folder, one.line + " --output " + one.output);
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  return result_in(folder, one.output);
}

/// Lines of a shell that wait for a condition, or for process $pid to end.
std::string wait_until(const std::string& condition) {
  return "while kill -0 $pid 2>/dev/null; do " + condition + " && break; sleep .01; done\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(of_errors_only_those_of_the_launcher_are_left_out) {
  const std::string launcher =
      "[hwloc/linux] failed to find sysfs cpu topology directory\n*****\n* hwloc has found\n*****\n";
  BOOST_TEST(without_launcher(launcher) == "");
  BOOST_TEST(without_launcher(launcher + "nysalt: no\n" + launcher) == "nysalt: no\n");
}

BOOST_AUTO_TEST_CASE(ranks_and_threads_change_no_byte) {
  for (const auto& one : shared_commands()) ranks_change_no_byte(one);
}

// Ranks leave no trace in what is printed and written.
BOOST_AUTO_TEST_CASE(other_commands_are_done_once) {
  const scratch folder("ranks_others");
  for (const std::string arguments : {"list", "stability --method verlet --output curve.csv", "new mine"}) {
    const auto done = run_on(3, folder, arguments);
    BOOST_TEST(done.code == 0, done.err);
    const scratch other("ranks_alone");
    const auto alone = run(other, arguments);
    BOOST_TEST(done.out == alone.out);
    BOOST_TEST(done.err == "");
    for (const auto& name : other.files())
      BOOST_TEST((name == "manifest.json" || contents(folder / name) == contents(other / name)), name);
  }
}

BOOST_AUTO_TEST_CASE(bad_input_is_told_once) {
  const scratch folder("ranks_refused");
  std::ofstream(folder / "file") << "no folder\n";
  for (const std::string& arguments :
       {std::string("compare --methods nobody --steps 0.02"),
        compare + "path --output file/report",  // which rank 0 alone looks for
        std::string("stability --method verlet --output file/curve.csv"),
        std::string("learn --family nystrom --step -1"),
        std::string("learn --family nystrom --step 0.03 --output missing/s.json"),
        std::string("learn --stepp 1"), in_bath("20") + "--output none/a.csv",
        std::string("run --method mine.json --step 0.1 --horizon 1 --output a.csv"),
        std::string("sample --system pendulum --length 0"),
        std::string("sample --system pendulum --length 1 --resume")}) {
    const auto alone = run(folder, arguments);
    const auto together = run_on(3, folder, arguments);
    BOOST_TEST_CONTEXT(arguments << ": " << together.err) {
      BOOST_TEST(alone.code == 2);
      BOOST_TEST(together.code == 2);
      BOOST_TEST(sentences_in(together.err) == 1);
      BOOST_TEST(together.err.find(alone.err) != std::string::npos);
      BOOST_TEST(together.out == "");
    }
  }
  BOOST_TEST(folder.files().size() == 1U);
  // Found out in the midst, by rank 0 alone: its folder has another name.
  const auto done = shell(folder, "mkdir d\n" + on_ranks(2) + in_bath("400") +
                                      "--output d/a.csv --checkpoint d/c --every 100 & pid=$!\n" +
                                      wait_until("[ -e d/c ]") + "mv d e; wait $pid");
  BOOST_TEST(done.code == 4, done.err);
  BOOST_TEST(sentences_in(done.err) == 1, done.err);
  BOOST_TEST(done.err.find("cannot write d/") != std::string::npos, done.err);
  const auto lost = run_on(2, folder,
                           "run --system henon_heiles --spread 50 --method verlet --step 0.3 --horizon 600 "
                           "--trajectories 40 --output a.csv");
  BOOST_TEST(lost.code == 3, lost.err);
}

BOOST_AUTO_TEST_CASE(ranks_may_have_other_threads_and_nothing_else) {
  const scratch folder("ranks_unlike");
  const auto unlike = [&](const std::string& option) {
    return shell(folder, mpirun(2) + "sh -c 'exec \"$nysalt\" " + in_bath("20") + option +
                             "$((3 - 2*OMPI_COMM_WORLD_RANK)) --output b.csv'");
  };
  const auto seeds = unlike("--seed ");
  BOOST_TEST(seeds.code == 2);
  BOOST_TEST(seeds.err.find("rank 1 must have the options of rank 0") != std::string::npos, seeds.err);
  BOOST_TEST(sentences_in(seeds.err) == 1, seeds.err);
  BOOST_TEST(folder.files().empty());
  const auto threads = unlike("--threads ");
  BOOST_TEST(threads.code == 0, threads.err);
  BOOST_TEST((contents(folder / "b.csv") == undisturbed({in_bath("20"), "b.csv", "", ""})));
}

// A rank is killed in the midst; other numbers of ranks go on.
BOOST_AUTO_TEST_CASE(a_rank_that_dies_ends_the_job_and_others_go_on_with_it) {
  const std::string at_step = "grep -q '\"first\":[0-9]*,\"step\":[5-9][0-9][0-9]' c 2>/dev/null";
  struct killed {
    stoppable command;
    std::string condition;
    int ranks;
  };
  for (const auto& [command, condition, ranks] : std::vector<killed>{
           {{in_bath("400"), "a.csv", "--checkpoint c --every 100 --threads 1", "c"}, at_step, 0},
           {{in_bath("400"), "a.npy", "--checkpoint c --every 100 --threads 1", "c"}, at_step, 2},
           {{sample, "a.csv", "--checkpoint c --every 10 --threads 1", "c"}, "[ -f c ]", 3},
           {{compare + "path,acceptance", "o", "--threads 1", "o/journal.jsonl"},
            "[ \"$(cat o/journal.jsonl 2>/dev/null | wc -l)\" -gt 2 ]",
            3}}) {
    const scratch folder("ranks_killed");
    const auto done = shell(folder, on_known_ranks(2, command.command()) + " >/dev/null 2>&1 & pid=$!\n" +
                                        wait_until(condition) + "kill -9 $(cat pid.1) && ! wait $pid");
    BOOST_TEST(done.code == 0, command.line << done.err);  // one that dies ends all
    BOOST_TEST_REQUIRE(std::filesystem::exists(folder / command.kept));
    const auto refused = run_on(2, folder, command.command());
    BOOST_TEST(refused.code == 2);
    BOOST_TEST(sentences_in(refused.err) == 1, refused.err);
    BOOST_TEST(refused.err.find("take --resume") != std::string::npos, refused.err);
    goes_on(ranks, folder, command, undisturbed(command));
  }
}

// A batch system may warn any of the ranks, or all. Sites that ranks shared are resumed by one, and the other
// way.
BOOST_AUTO_TEST_CASE(a_signal_to_any_rank_makes_a_checkpoint) {
  const stoppable command{in_bath("4000"), "a.csv", "--threads 1 --checkpoint c --every 20000", "c"};
  const std::string expected = undisturbed(command);
  for (const std::string to : {"pid.0", "pid.1", "pid.0 pid.1"}) {
    const scratch folder("ranks_signalled");
    const auto done = shell(folder, on_known_ranks(2, command.command()) + " >/dev/null 2>err & pid=$!\n" +
                                        wait_until("grep -q '\"step\":[1-9]' c 2>/dev/null") +
                                        "kill -USR1 $(cat " + to + "); wait $pid; echo $?");
    const std::string err = contents(folder / "err");
    BOOST_TEST(done.out == "138\n", to << ": " << done.out << err);
    BOOST_TEST(err.find("signal 10 ended it; take --resume") != std::string::npos, err);
    BOOST_TEST(sentences_in(err) == 1, err);
    goes_on(0, folder, command, expected);
  }
  const stoppable sites{
      "run --system fpu --pairs 6000 --method verlet --step 0.01 --horizon 160 --sample-every 64 "
      "--observables "
      "energy,q1,p12000 --trajectories 2",
      "a.csv", "--threads 1 --checkpoint c --every 64", "c"};
  const std::string expected_sites = undisturbed(sites);
  for (const int first : {3, 0}) {
    const scratch folder("ranks_sites");
    const auto stopped = shell(folder, (first == 0 ? std::string("\"$nysalt\" ") : on_ranks(first)) +
                                           sites.command() + " >/dev/null 2>&1 & pid=$!\n" +
                                           wait_until("grep -q '\"step\":[5-9][0-9][0-9]' c 2>/dev/null") +
                                           "kill -TERM $pid; ! wait $pid");
    BOOST_TEST(stopped.code == 0, stopped.err);
    BOOST_TEST_REQUIRE(std::filesystem::exists(folder / "a.csv.part"));
    goes_on(3 - first, folder, sites, expected_sites);
  }
}
