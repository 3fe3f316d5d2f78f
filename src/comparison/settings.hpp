// SPDX-License-Identifier: BSL-1.0
// Settings that every command takes, besides its own.
#pragma once

#include <cstddef>
#include <string>

#include "nysalt/comparison_options.hpp"

namespace nysalt::program {

/// How much of a result is printed for people, and how wide.
struct text_form {
  bool is_verbose = false;  // with all details, of any width
  std::size_t width = 110;  // columns, beyond which lines are broken
};

struct common_settings : common_options {
  bool json = false;
  bool verbose = false;  // all details in the text
  std::string command;   // the whole command line, for results
  std::string options;   // what was asked for by it and by files of options, as TOML
};

}  // namespace nysalt::program
