// SPDX-License-Identifier: BSL-1.0
// The program run in this process on a mutated input, and what it promises whatever it is given.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace nysalt::fuzz {

struct input_file {
  std::string name;
  std::string text;
};

/// Whether a part of the program that reads takes an input, in a folder that holds these files alone: it
/// returns or throws. It promises as much as a command: where a promise is broken the process aborts.
bool takes(const std::function<void()>& part, const std::vector<input_file>& inputs = {});

/// Whether a text is one of those, one in n, for which more is done; the same ones each time.
inline bool is_one_in(std::size_t n, const std::string& text) {
  return std::hash<std::string>{}(text) % n == 0;
}

/// Runs `nysalt arguments` in a folder of its own that holds these files alone. Where the program breaks a
/// promise it is told on standard error, and the process aborts.
void run(const std::vector<std::string>& arguments, const std::vector<input_file>& inputs);

/// How often the program ended with each exit code.
const std::array<long, 4>& tally();

/// What a run left behind.
struct remains {
  int code;
  std::string out;
  std::string err;
  std::set<std::string> files;
  bool inputs_are_whole = true;
};

/// The promise that is broken, in words; empty if all are kept:
///  - the exit code is 0, 2 or 3;
///  - with 2 there is one line of plain characters on standard error and nothing else, printed or written;
///  - no file is left half written, whatever the code.
std::string broken_promise(const remains& left, const std::set<std::string>& files_before);

}  // namespace nysalt::fuzz
