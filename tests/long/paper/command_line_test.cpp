// SPDX-License-Identifier: BSL-1.0
// The command line of `nysalt_paper`: help whose examples run, the version, and what it refuses.
#include <boost/test/unit_test.hpp>

#include <sstream>
#include <string>

#include "../../support/program.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(help_shows_examples_that_run) {
  const auto help = run("--help");
  BOOST_TEST(help.code == 0);
  BOOST_TEST(help.err == "");
  for (const char* option : {"--quick", "--output", "--seed", "--threads", "--config", "--json"})
    BOOST_TEST(help.out.find(option) != std::string::npos, "no " << option);
  const scratch folder("paper_help");
  const std::string start = "  nysalt_paper ";
  int examples = 0;
  std::istringstream lines(help.out);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(start)) continue;
    const auto done = run(folder, line.substr(start.size()));
    BOOST_TEST(done.code == 0, line << ": " << done.err);
    ++examples;
  }
  BOOST_TEST(examples == 2);
  BOOST_TEST(run("--version").out.starts_with("nysalt_paper "));
}

BOOST_AUTO_TEST_CASE(options_of_a_file_are_those_typed) {
  const scratch folder("paper_options");
  const std::string file = "printf 'json = true\\nseed = 2\\n' >options.toml && ";
  const auto typed = run(folder, "linear --json --seed 2");
  BOOST_TEST(typed.code == 0);
  BOOST_TEST(shell(folder, file + "\"$nysalt\" linear --config options.toml").out == typed.out);
}

BOOST_AUTO_TEST_CASE(bad_input_is_refused) {
  const scratch folder("paper_bad");
  all_refused(folder, {{"quadratic", {"quadratic", "linear, deterministic, langevin"}},
                       {"reproduce", {"reproduce", "linear, deterministic, langevin"}},
                       {"linear --output /dev/null/results", {"not a folder"}},
                       {"linear --output ''", {"--output", "empty", "nysalt_paper --help"}},
                       {"linear --threads 0", {"--threads"}},
                       {"linear --quik", {"--quik", "did you mean --quick?"}},
                       {"linear --config absent.toml", {"absent.toml"}},
                       {"linear --step 1", {"--step"}}});
  // No process writes to the FIFO: who reads it waits.
  const auto waiting = shell(folder, "mkfifo pipe; \"$nysalt\" linear --config pipe", 60);
  BOOST_TEST(waiting.code == 2);
  BOOST_TEST(waiting.err.find("not a regular file") != std::string::npos, waiting.err);
}
