// SPDX-License-Identifier: BSL-1.0
// Options from a TOML file.
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/program.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

/// A folder with the file options.toml of that text.
struct folder_with : scratch {
  explicit folder_with(const std::string& text) : scratch("config") {
    std::ofstream(path() / "options.toml") << text;
  }
};

/// What is printed with the file, times aside.
std::string with(const std::string& text, const std::string& line) {
  const auto done = run(folder_with(text), line + " --config options.toml");
  BOOST_TEST(done.code == 0, line << " with\n" << text << "\nsaid " << done.err);
  BOOST_TEST(done.err == "");
  return without_times(done.out);
}

std::string typed(const std::string& line) {
  const auto done = run(line);
  BOOST_TEST(done.code == 0, line << " said " << done.err);
  return without_times(done.out);
}

const std::string learned =
    "learn --family nystrom --step 0.02 --trajectories 3 --seed 4 --fix b1=0.5 --json";
const std::string compared =
    "compare --methods verlet,bcss2 --steps 0.005,0.01 --equal-cost --trajectories 3 --seed 4 --json";
const std::string sections =
    "seed = 4  # for all commands\n"
    "[learn]\nstep = 0.02\ntrajectories = 3\nfix = [\"b1=0.5\"]\n"
    "[compare]\nmethods = [\"verlet\", \"bcss2\"]\nsteps = [0.005, 0.01]\nequal-cost = true\ntrajectories = "
    "3\n";

}  // namespace

BOOST_AUTO_TEST_CASE(options_outside_sections_are_of_the_command_that_runs) {
  BOOST_TEST(with("step = 0.02\ntrajectories = 3\nseed = 4\nfix = [\"b1=0.5\"]\njson = true",
                  "learn --family nystrom") == typed(learned));
  BOOST_TEST(with("step = 0.02\ntrajectories = 4\nseed = 4\nfix = [\"b1=0.5\"]\njson = true",
                  "learn --family nystrom") != typed(learned));
  BOOST_TEST(with("family = \"nystrom\"\nparameters = [0.5, 0.4]", "stability") ==
             typed("stability --family nystrom --parameters 0.5,0.4"));
  BOOST_TEST(with("method = \"verlet\"\nstep = 0.01\nhorizon = 0.03\nobservables = [\"energy\", \"q1\"]",
                  "run") == typed("run --method verlet --step 0.01 --horizon 0.03 --observables energy,q1"));
}

BOOST_AUTO_TEST_CASE(a_line_is_shorter_than_an_argument_may_be) {
  constexpr std::size_t longest = 131072;  // of Linux, MAX_ARG_STRLEN
  const std::string line = "run --step 0.01 --horizon 0.03";
  std::string text = "method = \"verlet\"  # ";
  text.resize(longest - 1, 'x');
  BOOST_TEST(with(text + "\n", line) == typed(line + " --method verlet"));
  const auto refused = run(folder_with(text + "x\n"), line + " --config options.toml");
  BOOST_TEST(refused.code == 2);
  BOOST_TEST(
      refused.err.find("line 1: a line must be shorter than 131072 bytes, got 131072") != std::string::npos,
      refused.err);
}

BOOST_AUTO_TEST_CASE(a_section_is_of_its_command) {
  BOOST_TEST(with(sections, "learn --family nystrom --json") == typed(learned));
  BOOST_TEST(with(sections, "compare --json") == typed(compared));
  BOOST_TEST(with("seed = 5\n[learn]\nseed = 4\n",
                  learned.substr(0, learned.find(" --seed 4")) + " --fix b1=0.5 --json") == typed(learned));
}

BOOST_AUTO_TEST_CASE(a_section_of_another_command_changes_nothing) {
  const std::string line = "compare --methods verlet --steps 0.01 --trajectories 3 --json";
  BOOST_TEST(with("[learn]\nseed = 9\n[cite]\nmethods = \"bcss2\"\n", line) == typed(line));
  BOOST_TEST(with("[compare]\nseed = 9\n", line) != typed(line));

  // Nor is it written down with what was made.
  const folder_with folder("[learn]\nstep = 0.02\ntrajectories = 3\n[recommend]\nhorizon = 2\nseed = 9\n");
  BOOST_TEST_REQUIRE(run(folder, "learn --config options.toml --output scheme.json").code == 0);
  const auto manifest = recorded(folder / "scheme.json");
  BOOST_TEST(manifest["seed"] == 1);
  BOOST_TEST(manifest["options"] == "learn.step=0.02\nlearn.trajectories=3\nlearn.output=\"scheme.json\"\n");
}

BOOST_AUTO_TEST_CASE(a_list_may_also_be_one_text) {
  BOOST_TEST(
      with(
          "methods = \"verlet,bcss2\"\nsteps = \"0.005,0.01\"\nequal-cost = true\ntrajectories = 3\nseed = 4",
          "compare --json") == typed(compared));
}

BOOST_AUTO_TEST_CASE(the_file_may_be_named_before_the_command) {
  const folder_with folder(sections);
  const auto done = run(folder, "--config options.toml learn --family nystrom --json");
  BOOST_TEST(done.code == 0);
  BOOST_TEST(without_times(done.out) == typed(learned));
}

BOOST_AUTO_TEST_CASE(the_command_line_wins) {
  const std::string other =
      "seed = 9\n[learn]\nstep = 0.03\ntrajectories = 2\nfix = [\"beta1=0.4\"]\n"
      "[compare]\nmethods = [\"srkn6b\"]\nsteps = [0.03]\ntrajectories = 2\n";
  BOOST_TEST(with(other, learned) == typed(learned));
  BOOST_TEST(with(other, compared) == typed(compared));
}

BOOST_AUTO_TEST_CASE(what_is_no_option_is_refused) {
  for (const char* text :
       {"nosuch = 1\n", "[learn]\nnosuch = 1\n", "[nosuch]\nstep = 0.02\n", "[nosuch]\n"}) {
    const auto done = run(folder_with(text), learned + " --config options.toml");
    BOOST_TEST(done.code == 2, text);
    BOOST_TEST(done.out == "");
    BOOST_TEST(done.err.find("nosuch") != std::string::npos, done.err);
  }
}

// A pipe can be read once, and the system is read before the options are.
BOOST_AUTO_TEST_CASE(options_of_a_pipe_count) {
  const scratch folder("config");
  const std::string line = "run --method verlet --step 0.01 --horizon 0.02 --observables energy ";
  const std::string expected = run(folder, line + "--seed 5").out;
  BOOST_TEST(expected != run(folder, line).out);
  for (const char* more : {"", "--system fpu "}) {
    const auto done = shell(folder, "echo seed = 5 | \"$nysalt\" " + line + more + "--config /dev/stdin");
    BOOST_TEST(done.code == 0, done.err);
    BOOST_TEST(done.out == expected);
  }
}

// What CLI11 would read wrongly without a word.
BOOST_AUTO_TEST_CASE(what_is_not_plain_is_refused_with_its_line) {
  const std::string good = "step = 0.02\n";
  for (const char* text :
       {"fix = [\"b1=0.5\"\n", "output = \"h#b.json\"\n", "step = 0.03\n", "horizon = [\n0.5]\n", "horizon\n",
        "horizon =\n", "[learn]\n[compare]\n[learn]\n",
        // CLI11 marks the ends of sections by such names, and an empty section is none of its.
        "=2\n", "++=1\n", "--=1\n", "learn.++=1\n", "x.--=3\n", "[]\n", "[++]\n"}) {
    const auto done = run(folder_with(good + text), "learn --config options.toml");
    BOOST_TEST(done.code == 2, text);
    BOOST_TEST(done.err.starts_with("nysalt: --config, line "), done.err);
  }
}
