// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fstream>
#include <string>

namespace nysalt::bench {

/// Of this machine, by name.
inline std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace nysalt::bench
