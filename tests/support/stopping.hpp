// SPDX-License-Identifier: BSL-1.0
// Commands that are killed at a chosen call of the system, and go on to the same bytes. Killed between two
// calls, a process leaves what it leaves at the second of them: files change by calls alone.
#pragma once

#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "program.hpp"

namespace nysalt::test {

/// A shell's words before a program that is to fail or to be killed at a call (tests/faults/fail.cpp).
inline std::string with_fault(const std::string& fault) {
  return "NYSALT_FAULT=" + fault + " LD_PRELOAD='" NYSALT_FAULTS "' ";
}

/// Without gnuplot, which would take most of the time.
constexpr const char* no_pictures = "PATH=/nowhere ";

/// `nysalt line`, which is killed without warning before that call, as "rename:4".
inline bool is_killed_at(const scratch& folder, const std::string& call, const std::string& line) {
  return shell(folder, no_pictures + with_fault(call + ":kill") + "\"$nysalt\" " + line).code == 128 + 9;
}

inline finished quietly(const scratch& folder, const std::string& line) {
  return shell(folder, no_pictures + ("\"$nysalt\" " + line));
}

/// Calls of each kind that `nysalt line` makes.
inline std::map<std::string, int> calls_of(const scratch& folder, const std::string& line) {
  const auto done = shell(
      folder, no_pictures +
                  std::string("NYSALT_FAULT_COUNTS=$PWD/calls LD_PRELOAD='" NYSALT_FAULTS "' \"$nysalt\" ") +
                  line);
  BOOST_TEST_REQUIRE(done.code == 0, line << ": " << done.err);
  std::map<std::string, int> calls;
  std::ifstream file(folder / "calls");
  std::string operation;
  for (int count = 0; file >> operation >> count;) calls[operation] = count;
  return calls;
}

/// A command that can be stopped and resumed.
struct stoppable {
  std::string line;
  std::string output;  // a file, or the folder of a report
  std::string options = "";

  /// Where the work is kept while it is under way.
  std::string work() const { return output == "o" ? "o/report.work" : output + ".work"; }
  std::string command() const { return line + " --output " + output + " " + options; }
};

/// What equal runs have in common.
inline std::string result_in(const scratch& folder, const std::string& output) {
  if (!std::filesystem::is_directory(folder / output)) {
    const std::string text = contents(folder / output);
    return output.ends_with(".json") ? without_times(text) : text;
  }
  return without_times_in_csv(contents(folder / (output + "/rows.csv"))) +
         without_times(contents(folder / (output + "/report.json")));
}

/// Commands of each kind: noise and several blocks of lanes, samples where intervals between saved states
/// begin; trajectories that diverge at several steps; a processor; chains; parts of a comparison of every
/// kind; fits along a curve; a recommendation at a cost, and one for sampling.
inline std::vector<stoppable> stoppable_commands() {
  const std::string in_bath =
      "run --system fpu --friction 0.01 --sigma 0.05 --start law --method baoab --step 0.01 --horizon 4 "
      "--trajectories "
      "37 "
      "--sample-every 20 --observables stiff_energy,q1,p6";
  const std::string with_losses =
      "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 180 --trajectories 40 "
      "--sample-every 7";
  const std::string every = "--every 100";
  std::vector<stoppable> all{
      {in_bath, "o.csv", every},
      {in_bath, "o.npy", every},
      {with_losses, "o.csv", every},
      {"run --system henon_heiles --method takahashi_imada_processed --step 0.1 --horizon 40 --sample-every "
       "10",
       "o.csv", every},
      {"sample --system phi4 --masses 5 --length 1 --chains 37 --burn-in 100 --draws 30 --diagonal-masses",
       "o.csv", "--every 30"},
      {"compare --system oscillator --omega 1 --friction 0.5 --temperature 0.1 --methods "
       "verlet,learned:nystrom --steps 0.3 --horizon 10 --trajectories 32 --learn-trajectories 16 "
       "--learn-horizon 2 --metric path,state,acf,distribution",
       "o"},
      {"learn --system henon_heiles --family bab2 --steps 0.2,0.3 --horizon 3 --trajectories 16 --effort "
       "quick",
       "o.json"},
      {"recommend --system oscillator --omega 1 --budget 4 --horizon 20 --trajectories 40 --families nystrom "
       "--learn-trajectories 16",
       "o.json"},
      {"recommend --for sampling --system phi4 --masses 4 --length 1 --families bab3 --trajectories 16 "
       "--learn-trajectories 16 --learn-effort quick",
       "o.json"}};
  if (run(in_bath + " --output o.h5").err.find("built without HDF5") == std::string::npos)
    all.push_back({with_losses, "o.h5", every});
  return all;
}

/// Kills a command before each of the chosen calls, and what goes on once more before one of its first calls;
/// what then goes on by other numbers of threads comes to the bytes of a run that nothing happened to, which
/// are returned.
template <class Chosen>
std::string all_stops_come_to_the_same_bytes(const stoppable& one, Chosen is_chosen) {
  const scratch whole("stopping_whole");
  const auto undisturbed = quietly(whole, one.line + " --output " + one.output + " --json");
  BOOST_TEST_REQUIRE(undisturbed.code == 0, one.line << ": " << undisturbed.err);
  const std::string expected = result_in(whole, one.output);
  const scratch counting("stopping_counted");
  int kills = 0;
  const auto calls = calls_of(counting, one.command());
  BOOST_TEST((result_in(counting, one.output) == expected), one.command());  // saved often, not stopped
  // What takes equal seconds differs from run to run.
  const bool is_timed = one.line.find("--budget") != std::string::npos;
  for (const auto& [operation, count] : calls) {
    for (int number = 1; number <= count; ++number) {
      if (!is_chosen(number, count)) continue;
      const scratch folder("stopping");
      BOOST_TEST_CONTEXT(one.command() << " killed at " << operation << ":" << number) {
        const auto resume = [&] {
          return one.command() + (std::filesystem::exists(folder / one.work()) ? " --resume" : "");
        };
        // How often parts are written depends on how long that takes.
        kills += is_killed_at(folder, operation + ":" + std::to_string(number), one.command());
        // Whole or not there; of a recommendation the best so far.
        BOOST_TEST((!std::filesystem::exists(folder / one.output) || one.output == "o" ||
                    one.line.starts_with("recommend") || result_in(folder, one.output) == expected));
        is_killed_at(folder, "fsync:3", resume() + " --threads 1");  // unless it is finished before
        const auto done = quietly(folder, resume() + " --json --threads 2");
        BOOST_TEST_REQUIRE(done.code == 0, done.err);
        BOOST_TEST((result_in(folder, one.output) == expected));
        if (!is_timed) BOOST_TEST(without_times(done.out) == without_times(undisturbed.out));
        for (const auto& name : folder.files()) BOOST_TEST(name.find(".part") == std::string::npos, name);
        BOOST_TEST(!std::filesystem::exists(folder / one.work()));
      }
    }
  }
  // Without --every the number of writes depends on the speed of the disk; the first write always happens.
  BOOST_TEST(kills > (one.options.empty() ? 0 : 2), one.line);
  return expected;
}

}  // namespace nysalt::test
