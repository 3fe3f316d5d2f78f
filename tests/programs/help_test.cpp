// SPDX-License-Identifier: BSL-1.0
// Every command line that the program, the README, the tour or "choose a method" shows does what it is shown
// for.
#include <boost/test/unit_test.hpp>

#include <sstream>
#include <string>
#include <vector>

#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What follows a mark at the beginning of a line.
std::vector<std::string> after(const std::string& mark, const std::vector<std::string>& lines) {
  std::vector<std::string> found;
  for (const auto& line : lines) {
    if (line.starts_with(mark)) found.push_back(line.substr(mark.size()));
  }
  return found;
}

/// The lines of all ```sh blocks; one that ends with a backslash goes on in the next.
std::vector<std::string> shell_lines(const std::string& markdown) {
  std::vector<std::string> found;
  bool inside = false;
  bool goes_on = false;
  for (auto line : lines_of(markdown)) {
    if (line.starts_with("```")) {
      inside = !inside && line == "```sh";
      goes_on = false;
      continue;
    }
    if (!inside) continue;
    const bool unfinished = line.ends_with('\\');
    if (unfinished) line.pop_back();
    if (goes_on) {
      found.back() += line;
    } else {
      found.push_back(line);
    }
    goes_on = unfinished;
  }
  return found;
}

/// What a page calls the program with.
std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  for (const auto& line : shell_lines(contents(page))) {
    for (const char* program : {"nysalt ", "build/release/nysalt "}) {
      for (const auto& arguments : after(program, {line})) commands.push_back(arguments);
    }
  }
  return commands;
}

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

BOOST_AUTO_TEST_CASE(commands_are_found_in_a_text) {
  const std::string markdown =
      "nysalt not this\n```cpp\nnysalt nor this\n```\n```sh\n./dev test\nnysalt list  # all\n"
      "build/release/nysalt learn \\\n  --step 1\n```\nnysalt outside\n";
  const auto found = shell_lines(markdown);
  BOOST_TEST(found == (std::vector<std::string>{"./dev test", "nysalt list  # all",
                                                "build/release/nysalt learn   --step 1"}),
             boost::test_tools::per_element());
  BOOST_TEST(after("nysalt ", found) == std::vector<std::string>{"list  # all"},
             boost::test_tools::per_element());
  const scratch folder("help_self");
  BOOST_TEST(run(folder, "list  # all").code == 0);
  BOOST_TEST(run(folder, "lisp").code != 0);
}

BOOST_AUTO_TEST_CASE(examples_of_the_program_run) {
  for (const char* command : {"", "list --help", "learn --help", "run --help", "compare --help",
                              "recommend --help", "stability --help", "cite --help"}) {
    BOOST_TEST_CONTEXT("shown by nysalt " << command) {
      const auto help = run(command);
      BOOST_TEST(help.code == 0);
      BOOST_TEST(help.err == "");
      const auto examples = after("  nysalt ", lines_of(help.out));
      BOOST_TEST(examples.size() >= 2U);
      const scratch folder("help");
      for (const auto& example : examples) must_end_well(folder, made_short(example));
    }
  }
}

BOOST_AUTO_TEST_CASE(help_names_the_options_that_all_take) {
  for (const char* command : {"list", "learn", "run", "compare", "recommend", "stability"}) {
    const auto help = run(std::string(command) + " --help").out;
    for (const char* option : {"--help", "--seed", "--threads", "--config", "--json"})
      BOOST_TEST(help.find(option) != std::string::npos, command << " --help does not tell of " << option);
  }
}

// Of each page in one folder and in order: later lines read what earlier ones have written.
BOOST_AUTO_TEST_CASE(commands_of_the_readme_and_of_the_tour_run) {
  for (const char* page : {"README.md", "docs/tour.md"}) {
    BOOST_TEST_CONTEXT("shown by " << page) {
      const auto commands = commands_of(std::string(NYSALT_SOURCE_DIR "/") + page);
      BOOST_REQUIRE(commands.size() >= 8U);
      const scratch folder("readme");
      for (const auto& arguments : commands) must_end_well(folder, made_short(arguments));
    }
  }
}

BOOST_AUTO_TEST_CASE(races_of_the_how_to_run) {
  const scratch folder("races");
  int races = 0;
  for (const auto& arguments : commands_of(NYSALT_SOURCE_DIR "/docs/how-to/choose_a_method.md")) {
    const auto race = made_short(arguments);
    if (race == arguments) continue;
    must_end_well(folder, race);
    ++races;
  }
  BOOST_TEST(races >= 4);
  BOOST_TEST(run(folder, "recommend --system fpu --budget 60 --families aba4 --trajectories 16").code == 2);
}
