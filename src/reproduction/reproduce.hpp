// SPDX-License-Identifier: BSL-1.0
// The program nysalt_paper.
#pragma once

#include <string>
#include <vector>

#include "comparison/settings.hpp"

namespace nysalt::program::paper {

struct reproduce_command {
  std::vector<std::string> parts;  // of the paper; empty: all
  std::string output;              // a folder
  bool quick = false;
};

/// Computes the exhibits, prints their claims and writes them. Returns the exit code; throws refusal.
int reproduce(const reproduce_command& command, const common_settings& common);

}  // namespace nysalt::program::paper
