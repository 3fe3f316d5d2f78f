// SPDX-License-Identifier: BSL-1.0
// What was stopped goes on to the bytes of a run that nothing happened to: run, sample, compare and learn,
// killed at some of their calls of the system; at all of them in tests/long/programs/stopping_test.cpp.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/stopping.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(killed_it_goes_on_to_the_same_bytes) {
  for (const auto& one : stoppable_commands()) {
    const std::string expected = all_stops_come_to_the_same_bytes(
        one, [](int number, int count) { return number == (count + 2) / 2; });
    // Another seed has other bytes: so that equal bytes mean something.
    const scratch folder("stopping_other");
    BOOST_TEST_REQUIRE(quietly(folder, one.line + " --seed 2 --output " + one.output).code == 0);
    BOOST_TEST((result_in(folder, one.output) != expected), one.line);
  }
}

// A signal from another process, in the midst of the steps: tests/long/programs/signals_test.cpp.
BOOST_AUTO_TEST_CASE(a_signal_makes_a_checkpoint_where_one_was_asked_for) {
  const std::string line =
      "run --system fpu --friction 0.01 --sigma 0.05 --start law --method baoab --step 0.01 --horizon 60 "
      "--trajectories 5 --sample-every 700 --json --output o.csv ";
  const scratch whole("stopping_unsignalled");
  const auto undisturbed = run(whole, line);
  BOOST_TEST_REQUIRE(undisturbed.code == 0, undisturbed.err);
  for (const int number : {2, 15, 10}) {  // SIGINT, SIGTERM, and SIGUSR1, which Slurm sends
    const scratch folder("stopping_signalled");
    const std::string command = line + "--checkpoint c --every 1000";
    const auto done = shell(folder, with_fault("pwrite:3:signal_" + std::to_string(number)) + "\"$nysalt\" " +
                                        command + " >/dev/null; echo $?");
    BOOST_TEST(done.out == std::to_string(128 + number) + "\n", done.out << done.err);
    BOOST_TEST(done.err.find("take --resume to go on from the checkpoint") != std::string::npos, done.err);
    BOOST_TEST(!std::filesystem::exists(folder / "o.csv"));
    const auto resumed = run(folder, command + " --resume");
    BOOST_TEST_REQUIRE(resumed.code == 0, resumed.err);
    BOOST_TEST((contents(folder / "o.csv") == contents(whole / "o.csv")));
    BOOST_TEST(without_times(resumed.out) == without_times(undisturbed.out));
  }
}
