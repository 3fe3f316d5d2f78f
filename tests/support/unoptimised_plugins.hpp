// SPDX-License-Identifier: BSL-1.0
// Plug-ins that are compiled in less time, as tests of small systems want it.
#pragma once

#include <fstream>
#include <string>

#include "program.hpp"

namespace nysalt::test {

/// While it lives, "$nysalt" is a copy of the program that compiles plug-ins without optimisation: beside it
/// lie other flags.
class unoptimised_plugins {
 public:
  unoptimised_plugins() : folder_("unoptimised") {
    const std::filesystem::path whole = NYSALT_PROGRAM;
    std::filesystem::copy_file(whole, folder_ / "nysalt", std::filesystem::copy_options::overwrite_existing);
    std::ifstream flags(whole.parent_path() / "plugin.flags");
    std::ofstream ours(folder_ / "plugin.flags");
    for (std::string flag; std::getline(flags, flag);)
      ours << (flag.starts_with("-O") ? "-O0" : flag) << '\n';
    program() = folder_ / "nysalt";
  }
  unoptimised_plugins(const unoptimised_plugins&) = delete;
  unoptimised_plugins& operator=(const unoptimised_plugins&) = delete;
  ~unoptimised_plugins() { program() = NYSALT_PROGRAM; }

 private:
  scratch folder_;
};

}  // namespace nysalt::test
