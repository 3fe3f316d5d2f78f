// SPDX-License-Identifier: BSL-1.0
// The first four commands of the README; all that the program and the pages show is run in tests/long.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../support/program.hpp"
#include "../support/shown_commands.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(commands_are_found_in_a_text) {
  const std::string markdown =
      "nysalt not this\n```cpp\nnysalt nor this\n```\n```sh\n./dev test\nnysalt list  # all\n"
      "build/release/nysalt learn \\\n  --step 1\n```\nnysalt outside\n";
  BOOST_TEST(commands_of(markdown) == (std::vector<std::string>{"list  # all", "learn   --step 1"}),
             boost::test_tools::per_element());
  BOOST_TEST(run("list  # all").code == 0);
}

BOOST_AUTO_TEST_CASE(the_first_four_commands_of_the_readme_run) {
  const auto commands = commands_of(contents(NYSALT_SOURCE_DIR "/README.md"));
  BOOST_TEST_REQUIRE(commands.size() >= 4U);
  const scratch folder("readme");
  for (std::size_t k = 0; k < 4; ++k) {
    const auto done = run(
        folder, commands[k] + (commands[k].starts_with("learn") ? " --effort quick --trajectories 8" : ""));
    BOOST_TEST(done.code == 0, "nysalt " << commands[k] << ": " << done.err);
  }
}

BOOST_AUTO_TEST_CASE(help_names_the_options_that_all_take) {
  for (const char* command : {"list", "learn", "run", "compare", "recommend", "stability"}) {
    const auto help = run(std::string(command) + " --help").out;
    for (const char* option : {"--help", "--seed", "--threads", "--config", "--json"})
      BOOST_TEST(help.find(option) != std::string::npos, command << " --help does not tell of " << option);
    BOOST_TEST(behind("  nysalt ", lines_of(help)).size() >= 2U);
  }
}
