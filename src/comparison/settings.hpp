// SPDX-License-Identifier: BSL-1.0
// Settings that every command takes, besides its own.
#pragma once

#include <string>

#include "nysalt/comparison_options.hpp"

namespace nysalt::program {

struct common_settings : common_options {
  bool json = false;
  std::string command;  // the whole command line, for results
  std::string options;  // what was asked for by it and by files of options, as TOML
};

}  // namespace nysalt::program
