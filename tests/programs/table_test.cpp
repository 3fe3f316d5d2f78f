// SPDX-License-Identifier: BSL-1.0
// That rows of a table which are not as they must be are found (support/table.hpp), and commands of a page;
// the first four of the README run. All that the program and the pages show is run in tests/long.
#include <boost/test/unit_test.hpp>

#include <string>
#include <utility>
#include <vector>

#include "../support/program.hpp"
#include "../support/shown_commands.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(rows_that_are_wrong_are_found) {
  const std::string run =
      "run --system fpu --method verlet --step 0.01 --horizon 0.02 --observables energy,q1";
  const std::string json = "0 " + run + " --json";
  for (const auto& [row, why] : std::initializer_list<std::pair<std::string, std::string>>{
           {"2 list", "ended with 0"},
           {"0 lisp", "ended with 2"},
           {"0 lisp", "must say nothing"},
           {"0 $ echo hm >&2", "must say nothing"},
           {"2 $ echo no >&2; exit 2", "must be one line of nysalt"},
           {"2 $ printf 'nysalt: a\\nb\\n' >&2; exit 2", "must be one line of nysalt"},
           {"2 $ echo 'nysalt: no' >&2; echo out; exit 2", "printed out"},
           {"2 $ echo 'nysalt: no' >&2; echo x >file; exit 2", "the folder changed"},
           {"0 $ echo 'filesystem error: x' >&2 | any err", "filesystem error"},
           {"2 lisp | no such words", "not so: no such words"},
           {"2 lisp | not: lisp", "not so: not: lisp"},
           {"0 list | out: no such words", "not so: out:"},
           {"0 list | not out: fpu", "not so: not out:"},
           {"0 list | first: no such words", "not so: first:"},
           {"0 $ echo 0123456789 | width: 9", "not so: width: 9"},
           {"0 $ echo >a | files:", "not so: files:"},
           {"0 $ echo >a | files: a b", "not so: files: a b"},
           {"0 $ echo x >a | holds a: y", "not so: holds a: y"},
           {json + " | golden: diverged 1e-9", "/step is 0.01, not 0.05"},
           {json + " --seed 2 | golden: run 1e-10", "/rows/0/3 is"},
           {json + " --trajectories 2 | golden: run 1e-10", "/trajectories is 2, not 1"},
           {"0 list --json | golden: run 1e-10", " is {\"version\""},
           {"0 $ sed 's/\"step\":/\"stop\":/' $source/golden/run.json | golden: run 1e-10",
            " has stop where step was"},
           {"0 $ sed 's/\"~number\"/null/' $source/golden/run.json | golden: run 1e-10", "/seconds is ~null"},
           {json + " | json: /steps = 3", "not so: json:"},
           {json + " | json: /rows# > 3", "not so: json:"},
           {json + " | json: /rows/0/3 ~ 1 1e-9", "not so: json:"},
           {json + " | json: /rows/*/1 = [0, 2, 1]", "not so: json:"},
           {json + " | json: /columns has p1", "not so: json:"},
           {json + " | json: /columns lacks q1", "not so: json:"},
           {json + " | json: /columns/* set step t", "not so: json:"},
           {json + " | json: /nothing = 1", "nothing"},
           {"0 list | label: l\n0 --help | same: l", "not so: same:"},
           {"0 list | label: l\n0 list | other: l", "not so: other:"},
           {"sh false", "ended with 1"},
           {"x0 list", "must be found wrong"},
           {"2 {lisp;list} | command", "ended with 0"}}) {
    const auto wrong = wrong_rows(row, "self");
    BOOST_TEST_CONTEXT(row) {
      BOOST_TEST_REQUIRE(wrong.size() == 1U);
      BOOST_TEST(wrong[0].find(why) != std::string::npos, wrong[0]);
    }
  }
}

BOOST_AUTO_TEST_CASE(rows_that_are_right_are_not) {
  const auto wrong = wrong_rows(
      "# A comment.\nlet words = did you mean list?\n== first\nfile a b.txt = x\\x41\\n\nsh grep -q xA 'a "
      "b.txt'\n"
      "@ list\n0 {;--json} | not out: nothing\n@\n2 lisp | {words} | not: nothing\nx2 lisp | nothing\n"
      "== second\n0 $ ls | files: | label: none\n0 $ true | out: \n0 $ echo ±±± | width: 3 | first: ±\n",
      "self");
  for (const auto& one : wrong) BOOST_TEST(false, one);
}

BOOST_AUTO_TEST_CASE(commands_are_found_in_a_text) {
  const std::string markdown =
      "nysalt not this\n```cpp\nnysalt nor this\n```\n```sh\n./dev test\nnysalt list  # all\n"
      "build/release/nysalt learn \\\n  --step 1\n```\nnysalt outside\n";
  BOOST_TEST(commands_of(markdown) == (std::vector<std::string>{"list  # all", "learn   --step 1"}),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(the_first_four_commands_of_the_readme_run) {
  auto commands = commands_of(contents(NYSALT_SOURCE_DIR "/README.md"));
  BOOST_TEST_REQUIRE(commands.size() >= 4U);
  commands.resize(4);
  std::string rows;
  for (const auto& command : commands)
    rows += "0 " + command + (command.starts_with("learn") ? " --effort quick --trajectories 8" : "") +
            " | any err\n";
  for (const auto& one : wrong_rows(rows, "readme")) BOOST_TEST(false, one);
}
