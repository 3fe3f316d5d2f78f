// SPDX-License-Identifier: BSL-1.0
// What no output may replace or remove: files that were read, and what is no regular file. Each name that a
// command writes is tried, and each kind of input, before any work; plug-ins as inputs are in
// long/programs/cases/own_systems.txt.
#include <boost/test/unit_test.hpp>

#include <map>
#include <string>
#include <vector>

#include "../support/table.hpp"

namespace {

using texts = std::vector<std::string>;

/// A command, the kinds of input that it takes, and the files that it writes.
struct writer {
  std::string command;
  texts inputs;
  texts outputs;
};

const texts of_a_run{"o.csv", "manifest.json", "o.svg", "o.png", "o.gp", "o.dat"};
const std::vector<writer> writers{
    {"run --step 0.01 --horizon 0.1 --trajectories 2 --output o.csv --plot",
     {"method", "config", "data", "start"},
     of_a_run},
    {"run --step 0.01 --horizon 0.1 --trajectories 2 --output o.csv --plot --checkpoint c.ck --every 10",
     {"method", "config", "data", "start"},
     {"o.csv", "manifest.json", "c.ck", "o.dat"}},
    {"stability --step 0.01 --output o.csv --plot", {"method", "config", "data", "start"}, of_a_run},
    {"sample --length 0.5 --draws 5 --burn-in 5 --chains 2 --output o.csv --checkpoint c.ck --every 3",
     {"method", "config", "data", "start"},
     {"o.csv", "manifest.json", "c.ck"}},
    {"learn --family nystrom --step 0.1 --trajectories 4 --horizon 0.4 --output s.json",
     {"config", "start", "data"},
     {"s.json", "manifest.json"}},
    {"recommend --families nystrom --budget 20 --horizon 1 --output s.json",
     {"config", "start"},
     {"s.json", "manifest.json"}},
    {"export --to c --output m.c", {"exported"}, {"m.c", "manifest.json"}},
    {"compare --steps 0.01 --trajectories 2 --horizon 0.1 --output r",
     {"methods", "config", "data", "start"},
     {"r/manifest.json", "r/pictures/manifest.json", "r/journal.jsonl", "r/report.json", "r/report.md",
      "r/report.html", "r/rows.csv", "r/pictures/energy_at_0_01.svg", "r/pictures/energy_at_0_01.png",
      "r/pictures/energy_at_0_01.gp", "r/pictures/energy_at_0_01.dat"}}};

/// The arguments by which a command reads an input.
std::string arguments_for(const std::string& kind, const std::string& name, const std::string& command) {
  const bool takes_none = command.starts_with("learn") || command.starts_with("recommend");
  const std::string method = command.starts_with("compare") ? " --methods " : " --method ";
  const std::string of_method = takes_none ? "" : method + "verlet";
  if (kind == "exported") return " " + name;
  if (kind == "method" || kind == "methods") return method + name + " --system pendulum";
  if (kind == "data") return of_method + " --system logistic_regression --data " + name;
  if (kind == "config") return of_method + " --system pendulum --config " + name;
  return of_method + " --system pendulum" + (kind == "start" ? " --start given.csv" : "");
}

const std::string table =
    R"({"format": "nysalt table", "version": 1, "name": "mine", "letters": "ABA", "coefficients": [0.5, 1, 0.5]})";
const std::map<std::string, std::string> inputs{{"method", table},
                                                {"methods", table},
                                                {"exported", table},
                                                {"config", "threads = 1\\n"},
                                                {"start", "q1\\n0.1\\n0.2\\n"},
                                                {"data", "x,y\\n0.1,0\\n0.4,1\\n-0.3,0\\n0.2,1\\n"}};

}  // namespace

// The kinds in turn, as names and kinds are not looked at together.
BOOST_AUTO_TEST_CASE(no_output_takes_a_name_of_an_input) {
  std::string rows;
  for (const auto& [command, kinds, outputs] : writers) {
    texts names;
    for (const auto& output : outputs) {
      for (const char* unfinished : {"", ".new.part"}) names.push_back(output + unfinished);
      if (output == "c.ck") names.emplace_back("c.ck.next.part");
      if (output == "o.csv" && command.find("--checkpoint") != std::string::npos) {
        names.emplace_back("o.csv.part");
        names.emplace_back("o.csv.sorted.part");
      }
    }
    BOOST_TEST(names.size() >= kinds.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto& kind = kinds[k % kinds.size()];
      const bool is_linked = kind == "start";
      rows += "== next\nsh mkdir -p r/pictures\nfile " + (is_linked ? "given.csv" : names[k]) + " = " +
              inputs.at(kind) + "\n";
      if (is_linked) rows += "sh ln -s \"$PWD/given.csv\" " + names[k] + "\n";
      rows += "2 " + command + arguments_for(kind, names[k], command) + " | was read as input\n";
    }
  }
  for (const auto& wrong : nysalt::test::wrong_rows(rows, "protected")) BOOST_TEST(false, wrong);
}

// Ways in turn, and all of them at one name; a device only the superuser can make.
BOOST_AUTO_TEST_CASE(nothing_but_a_regular_file_is_replaced) {
  const texts ways{"mkfifo NAME",
                   "mkfifo node && ln -s \"$PWD/node\" NAME",
                   "mknod NAME c 1 3 || mkdir NAME",
                   "(mknod node c 1 3 || mkdir node) && ln -s \"$PWD/node\" NAME",
                   "mkdir NAME",
                   "ln -s $(basename NAME) NAME"};
  std::string rows;
  std::size_t turn = 0;
  const auto add = [&](const std::string& command, const std::string& name, std::string way) {
    for (auto at = way.find("NAME"); at != std::string::npos; at = way.find("NAME")) way.replace(at, 4, name);
    rows += "== next\nsh mkdir -p r/pictures\nsh " + way + "\n2 " + command;
    rows += (command.starts_with("export") ? " verlet" : arguments_for("system", name, command)) +
            " | cannot write\n";
  };
  for (const auto& [command, kinds, outputs] : writers) {
    for (const auto& name : outputs) add(command, name, ways[turn++ % ways.size()]);
  }
  for (const auto& way : ways) add(writers[0].command, "o.csv", way);
  for (const auto& wrong : nysalt::test::wrong_rows(rows, "protected")) BOOST_TEST(false, wrong);
}
