// SPDX-License-Identifier: BSL-1.0
// Every command line that the program, the README, the tour or "choose a method" shows does what it is shown
// for. Tier 1 runs the first four commands of the README in tests/programs/table_test.cpp.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../../support/program.hpp"
#include "../../support/shown_commands.hpp"

using namespace nysalt::test;

namespace {

/// The same with a short search, and of recommendations with one family and few trajectories: this test is of
/// completeness, not of results.
std::string made_short(const std::string& arguments) {
  if (arguments.starts_with("learn")) return arguments + " --effort quick";
  const bool is_long =
      arguments.starts_with("recommend") && arguments.find("--families") == std::string::npos;
  const bool samples = arguments.find("--for sampling") != std::string::npos;
  return !is_long ? arguments
                  : arguments + (samples ? " --families bab3" : " --families aba4 --trajectories 16");
}

void must_end_well(const scratch& folder, const std::string& arguments) {
  const auto done = run(folder, arguments);
  // In that many seconds a step no method may be as fast, where the program is built to be examined.
  const bool depends_on_build = arguments.find("--budget-seconds") != std::string::npos;
  BOOST_TEST((done.code == 0 || (done.code == 3 && depends_on_build)),
             "nysalt " << arguments << ": " << done.code << ", " << done.err);
}

}  // namespace

BOOST_AUTO_TEST_CASE(examples_of_the_program_run) {
  for (const char* command : {"", "list --help", "learn --help", "run --help", "compare --help",
                              "recommend --help", "stability --help", "cite --help"}) {
    BOOST_TEST_CONTEXT("shown by nysalt " << command) {
      const auto help = run(command);
      BOOST_TEST(help.code == 0);
      BOOST_TEST(help.err == "");
      const auto examples = behind("  nysalt ", lines_of(help.out));
      BOOST_TEST(examples.size() >= 2U);
      const scratch folder("help");
      for (const auto& example : examples) must_end_well(folder, made_short(example));
    }
  }
}

// Of each page in one folder and in order: later lines read what earlier ones have written. Of "choose a
// method" the races alone, whose other commands read files of the reader.
BOOST_AUTO_TEST_CASE(commands_of_pages_run) {
  for (const std::string page : {"README.md", "docs/tour.md", "docs/how-to/choose_a_method.md"}) {
    BOOST_TEST_CONTEXT("shown by " << page) {
      auto commands = commands_of(contents(NYSALT_SOURCE_DIR "/" + page));
      const bool of_races = page.ends_with("method.md");
      if (of_races) std::erase_if(commands, [](const auto& line) { return made_short(line) == line; });
      BOOST_REQUIRE(commands.size() >= (of_races ? 4U : 8U));
      const scratch folder("readme");
      for (const auto& arguments : commands) must_end_well(folder, made_short(arguments));
    }
  }
}
