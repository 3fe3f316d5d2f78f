// SPDX-License-Identifier: BSL-1.0
// What no output may replace or remove: files that were read, and what is no regular file. Each under every
// name that a command writes, before any work.
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "../support/bad_input.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
namespace fs = std::filesystem;

namespace {

/// A command, the inputs that it takes, and the files that it writes.
struct writer {
  std::string command;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
};

const std::vector<std::string> of_a_report{"report.json", "report.md", "report.html", "rows.csv"};
const std::vector<std::string> pictures{"o.svg", "o.png", "o.gp", "o.dat"};
const std::string sampled = "--length 0.5 --draws 5 --burn-in 5 --chains 2 ";

std::vector<std::string> joined(std::vector<std::string> names, const std::vector<std::string>& others) {
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

/// A command on a system; the system or method is an option of the input where that is one.
std::vector<writer> writers() {
  const std::vector<std::string> of_a_table{"o.csv", "manifest.json"};
  const std::string run_it = "run --step 0.01 --horizon 0.1 --trajectories 2 --output o.csv --plot";
  std::vector<writer> all{
      {run_it, {"method", "config", "data", "start", "library", "source"}, joined(of_a_table, pictures)},
      {run_it + " --checkpoint c.ck --every 10",
       {"method", "config", "data", "start", "library", "source"},
       joined(of_a_table, {"c.ck", "o.dat"})},
      {"stability --step 0.01 --output o.csv --plot",
       {"method", "config", "data", "start", "library"},
       joined(of_a_table, pictures)},
      {"sample " + sampled + "--output o.csv --checkpoint c.ck --every 3",
       {"method", "config", "data", "start", "library"},
       joined(of_a_table, {"c.ck"})},
      {"learn --family nystrom --step 0.1 --trajectories 4 --horizon 0.4 --output s.json",
       {"config", "start", "library", "data"},
       {"s.json", "manifest.json"}},
      {"recommend --families nystrom --budget 20 --horizon 1 --output s.json",
       {"config", "start", "library"},
       {"s.json", "manifest.json"}},
      {"export --to c --output m.c", {"exported"}, {"m.c", "manifest.json"}},
      {"build ./given.hpp --output x.so", {"built", "config"}, {"x.so"}}};
  writer compared{"compare --steps 0.01 --trajectories 2 --horizon 0.1 --output r",
                  {"methods", "config", "data", "start", "library"},
                  {"r/manifest.json", "r/pictures/manifest.json", "r/journal.jsonl"}};
  for (const auto& name : of_a_report) compared.outputs.push_back("r/" + name);
  for (const char* kind : {".svg", ".png", ".gp", ".dat"})
    compared.outputs.push_back(std::string("r/pictures/energy_at_0_01") + kind);
  all.push_back(compared);
  return all;
}

/// The arguments by which a command reads an input.
std::string arguments_for(const std::string& kind, const std::string& name, const std::string& command) {
  const bool takes_none = command.starts_with("learn") || command.starts_with("recommend");
  const std::string method = command.starts_with("compare") ? " --methods " : " --method ";
  const std::string of_method = takes_none ? "" : method + "verlet";
  if (kind == "method" || kind == "methods") return method + name + " --system pendulum";
  if (kind == "exported") return " " + name;
  if (kind == "built") return "";
  if (kind == "config")
    return " --config " + name + (command.starts_with("build") ? "" : of_method + " --system pendulum");
  if (kind == "data") return of_method + " --system logistic_regression --data " + name;
  if (kind == "start") return of_method + " --system pendulum --start given.csv";
  if (kind == "library") return of_method + " --system ./" + name;
  return of_method + " --system ./given.hpp";
}

constexpr const char* source = R"(#include <nysalt/plugin.hpp>
struct well {
  static constexpr int dimension = 1;
  double k = 1.0;
  template <class T> T potential(const nysalt::vector<T, 1>& q) const { return 0.5 * k * q[0] * q[0]; }
};
using one = nysalt::vector<double, 1>;
NYSALT_SYSTEM(well, "a well", parameter("k", &well::k, "stiffness"),
              starts([](const well&) { return nysalt::normal_around<1>({one(1.0), one(0.0)}, 0.1, 0.1); }));
)";

/// Bytes of files and kinds of what else there is, by names.
std::map<std::string, std::string> all_in(const scratch& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    const auto type = entry.symlink_status().type();
    found[entry.path().string()] =
        type == fs::file_type::regular ? contents(entry.path()) : std::to_string(static_cast<int>(type));
  }
  return found;
}

/// The inputs, by their kinds, of which copies take the names of outputs.
std::map<std::string, std::string> contents_of_inputs(const scratch& inputs) {
  std::ofstream(inputs / "given.hpp") << source;
  BOOST_TEST_REQUIRE(run(inputs, "build given.hpp").code == 0);
  const std::string table =
      R"({"format": "nysalt table", "version": 1, "name": "mine", "letters": "ABA", "coefficients": [0.5, 1, 0.5]})";
  return {{"method", table},
          {"methods", table},
          {"exported", table},
          {"config", "threads = 1\n"},
          {"start", "q1\n0.1\n0.2\n"},
          {"library", contents(inputs / "given.so")},
          {"source", source},
          {"built", source},
          {"data", "x,y\n0.1,0\n0.4,1\n-0.3,0\n0.2,1\n"}};
}

void refused(const scratch& folder, const std::string& line, const std::string& words) {
  const auto before = all_in(folder);
  const auto done = shell(folder, "\"$nysalt\" " + line, 60);
  BOOST_TEST_CONTEXT("nysalt " << line << "\nsaid: " << done.err) {
    BOOST_TEST(done.code == 2);
    BOOST_TEST(done.out == "");
    BOOST_TEST(is_one_line(done.err));
    BOOST_TEST(done.err.find(words) != std::string::npos);
    BOOST_TEST(done.err.find("filesystem error") == std::string::npos);
    BOOST_TEST((all_in(folder) == before));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_output_takes_a_name_of_an_input) {
  const scratch inputs("protected_inputs");
  setenv("XDG_CACHE_HOME", (inputs / "cache").c_str(), 1);
  const auto texts = contents_of_inputs(inputs);
  for (const auto& [command, kinds, outputs] : writers()) {
    std::vector<std::string> names;
    for (const auto& output : outputs) {
      for (const char* unfinished : {"", ".new.part"}) names.push_back(output + unfinished);
      if (output == "c.ck") names.emplace_back("c.ck.next.part");
      if (output == "o.csv" && command.find("--checkpoint") != std::string::npos) {
        names.emplace_back("o.csv.part");
        names.emplace_back("o.csv.sorted.part");
      }
    }
    for (const auto& kind : kinds) {
      for (const auto& name : names) {
        const scratch folder("protected");
        fs::create_directories((folder / name).parent_path());
        const bool is_linked = kind == "start" || kind == "source" || kind == "built";
        const std::string given = kind == "start" ? "given.csv" : "given.hpp";
        std::ofstream(folder / (is_linked ? given : name)) << texts.at(kind);
        if (is_linked) fs::create_symlink(folder / given, folder / name);
        if (command.starts_with("build") && !is_linked) std::ofstream(folder / "given.hpp") << source;
        refused(folder, command + arguments_for(kind, name, command), "was read as input");
      }
    }
  }
}

// A checkpoint is written as well.
BOOST_AUTO_TEST_CASE(a_checkpoint_takes_no_name_of_the_run) {
  const scratch folder("protected_checkpoint");
  const std::string run_it =
      "run --method verlet --step 0.01 --horizon 0.1 --every 5 --output 'o x.csv' --plot --checkpoint ";
  for (const char* name :
       {"'o x.csv'", "'o x.csv.part'", "'o x.csv.new.part'", "'o x.csv.sorted.part'", "o_x.svg", "o_x.png",
        "o_x.gp", "o_x.dat", "o_x.dat.new.part", "manifest.json", "manifest.json.new.part"}) {
    refused(folder, run_it + name, "must not take the name of another file");
  }
  for (const char* name : {"o.csv", "o.csv.new.part", "manifest.json", "manifest.json.new.part"}) {
    refused(folder, "sample --system pendulum " + sampled + "--every 3 --output o.csv --checkpoint " + name,
            "must not take the name of another file");
  }
  refused(folder, "run --method verlet --step 0.01 --horizon 0.1 --output manifest.json.new.part",
          "record of how its files were made");
}

BOOST_AUTO_TEST_CASE(nothing_but_a_regular_file_is_replaced) {
  const scratch inputs("protected_nodes_inputs");
  setenv("XDG_CACHE_HOME", (inputs / "cache").c_str(), 1);
  const auto texts = contents_of_inputs(inputs);
  enum class node { fifo, link_to_fifo, device, link_to_device, folder, loop };
  for (const auto& [command, kinds, outputs] : writers()) {
    for (const auto& name : outputs) {
      for (const auto way :
           {node::fifo, node::link_to_fifo, node::device, node::link_to_device, node::folder, node::loop}) {
        const scratch folder("protected_node");
        const fs::path path = folder / name;
        fs::create_directories(path.parent_path());
        std::ofstream(folder / "given.hpp") << source;
        const bool is_link = way == node::link_to_fifo || way == node::link_to_device;
        const fs::path made = is_link ? folder / "node" : path;
        if (way == node::fifo || way == node::link_to_fifo) BOOST_TEST(mkfifo(made.c_str(), 0600) == 0);
        const bool is_device = way == node::device || way == node::link_to_device;
        if (is_device && mknod(made.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) continue;  // not root
        if (is_link) fs::create_symlink(made, path);
        if (way == node::folder) fs::create_directory(path);
        if (way == node::loop) fs::create_symlink(path.filename(), path);
        refused(folder,
                command + (command.starts_with("export")  ? " verlet"
                           : command.starts_with("build") ? ""
                                                          : arguments_for("source", name, command)),
                "cannot write");
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_stands_in_the_place_of_an_unfinished_file_is_seen_before_the_work) {
  for (const std::string command :
       {"run --method verlet --step 0.01 --horizon 1e9",
        "sample --system gaussian --size 3 --length 1 --draws 1000000000",
        "learn --family nystrom --step 0.02 --horizon 1e5"}) {  // work without end
    for (const std::string name : {"o.new.part", "manifest.json.new.part"}) {
      for (const bool is_link : {false, true}) {
        const scratch folder("protected_part");
        if (is_link)
          fs::create_symlink("nowhere", folder / name);
        else
          fs::create_directory(folder / name);
        refused(folder, command + " --output o", "not a regular file");
      }
    }
    const scratch folder("protected_part");
    fs::create_symlink("gone/deep", folder / "manifest.json");
    refused(folder, command + " --output o", "no folder");
  }
}

// Links that lead nowhere or back to themselves, and a folder that is gone.
BOOST_AUTO_TEST_CASE(folders_that_cannot_be_made_are_refused_before_the_work) {
  const std::string compared =
      "compare --methods verlet --steps 0.01 --trajectories 2 --horizon 0.1 --output r ";
  {
    const scratch folder("protected_link");
    fs::create_directory(folder / "r");
    fs::create_symlink("nowhere", folder / "r/pictures");
    refused(folder, compared, "r/pictures is not a folder");
  }
  {
    const scratch folder("protected_link");
    fs::create_symlink("nowhere", folder / "r");
    refused(folder, compared, "r is not a folder");
  }
  for (const char* name : {"journal.jsonl", "report.json", "report.html", "rows.csv"}) {
    const scratch folder("protected_loop");
    fs::create_directory(folder / "r");
    fs::create_symlink(name, folder / "r" / name);
    refused(folder, compared + "--resume", "is a link that leads back to itself");
  }
  const std::vector<std::string> lines{compared,
                                       "run --method verlet --step 0.01 --horizon 0.1 --output o.csv",
                                       "learn --step 0.1 --output s.json",
                                       "stability --method verlet --output o.csv",
                                       "new well",
                                       "run --method verlet --step 0.01 --horizon 0.1 --system ./a.so"};
  for (const auto& line : lines) {
    const scratch folder("protected_gone");
    const auto done = shell(folder, "mkdir gone && cd gone && rmdir ../gone && \"$nysalt\" " + line);
    BOOST_TEST(done.code == 2, line << " ended with " << done.code);
    BOOST_TEST(is_one_line(done.err), done.err);
    BOOST_TEST(done.err.find("filesystem error") == std::string::npos, done.err);
    BOOST_TEST((done.err.find("the current folder") != std::string::npos || line.ends_with(".so")), done.err);
  }
}

// What an earlier version left beside an output is read only if it is a file.
BOOST_AUTO_TEST_CASE(a_fifo_in_place_of_an_earlier_manifest_is_left_alone) {
  const scratch folder("protected_earlier");
  BOOST_TEST(mkfifo((folder / "o.csv.manifest.json").c_str(), 0600) == 0);
  const auto done =
      shell(folder, "\"$nysalt\" run --method verlet --step 0.01 --horizon 0.1 --output o.csv", 60);
  BOOST_TEST(done.code == 0, done.err);
  BOOST_TEST(fs::is_fifo(folder / "o.csv.manifest.json"));
}

// The finished parts of a comparison that was stopped.
BOOST_AUTO_TEST_CASE(a_journal_is_not_overwritten) {
  const scratch folder("protected_journal");
  std::ofstream(folder / "journal.jsonl") << "{\"format\":\"nysalt journal\",\"question\":{}}\n";
  for (const std::string line :
       {"run --method verlet --step 0.01 --horizon 0.1", "stability --method verlet"})
    refused(folder, line + " --output journal.jsonl", "the journal of a comparison that has not finished");
}
