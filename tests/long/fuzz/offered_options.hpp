// SPDX-License-Identifier: BSL-1.0
// The options of all commands. The program offers them, which takes longer than reading a line, at each
// start.
#pragma once

#include <string>
#include <vector>

#include "program/options/shared_options.hpp"
#include "program/options/subcommand.hpp"
#include "program/parse.hpp"

namespace nysalt::fuzz {

class offered_options {
 public:
  offered_options() {
    program::add_of_program(app_);
    commands_ = program::offer_all(app_, common_);
  }

  /// Reads a line of options, without the name of the program, and runs no command. Throws refusal.
  void read(std::vector<std::string> words) {
    words.insert(words.begin(), app_.get_name());
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    program::parse(app_, static_cast<int>(pointers.size()) - 1, pointers.data());
  }

 private:
  program::common_settings common_;
  CLI::App app_{"", "nysalt"};
  std::vector<program::subcommand> commands_;  // which own what the options are read into
};

}  // namespace nysalt::fuzz
