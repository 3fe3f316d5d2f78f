// SPDX-License-Identifier: BSL-1.0
// Command lines, one word a line. What is not said is taken from a file of options that make every run short.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <sstream>

#include "offered_options.hpp"
#include "program_run.hpp"

namespace {

using words = std::vector<std::string>;

const nysalt::fuzz::input_file short_runs{
    "short.toml",
    "threads = 1\n"
    "[run]\nmethod = \"verlet\"\nstep = 0.02\nhorizon = 0.06\n"
    "[learn]\nstep = 0.02\nhorizon = 0.06\ntrajectories = 2\n"
    "[compare]\nmethods = [\"verlet\"]\nsteps = [0.02]\nhorizon = 0.06\n"
    "trajectories = 2\nlearn-trajectories = 2\nlearn-horizon = 0.06\n"};

words words_of(const std::string& text) {
  std::istringstream lines(text);
  words all;
  for (std::string line; std::getline(lines, line);) all.push_back(line.substr(0, line.find('\0')));
  return all;
}

/// Commands that compute for seconds whatever they are told, and pictures, for which gnuplot is started.
bool is_dear(const words& typed) {
  const auto says = [&](const char* word) { return std::ranges::count(typed, word) > 0; };
  return says("recommend") || says("--plot") || (says("compare") && says("--output"));
}

bool is_long(const words& typed) {
  return std::ranges::any_of(typed, [](const std::string& word) {
    return word == "learn" || word == "compare" || word == "sample";
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  words typed = words_of(nysalt::fuzz::within_reach(text));
  if (is_dear(typed)) return 0;
  typed.insert(typed.begin(), {"--config", short_runs.name});
  static nysalt::fuzz::offered_options offered;
  const bool is_taken = nysalt::fuzz::takes([&] { offered.read(typed); }, {short_runs});
  // Commands take many times as long, and those that learn or sample still more.
  const std::size_t rarely = is_long(typed) ? 32 : 1;
  if (nysalt::fuzz::is_one_in(rarely * (is_taken ? 32 : 512), text)) nysalt::fuzz::run(typed, {short_runs});
  return 0;
}
