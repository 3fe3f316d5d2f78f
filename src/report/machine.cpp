// SPDX-License-Identifier: BSL-1.0
#include "machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace nysalt::program {

std::string machine() {
  std::string processor = "unknown processor";
  std::ifstream about("/proc/cpuinfo");
  for (std::string line; std::getline(about, line);) {
    const auto colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    processor = line.substr(colon + 2);
    break;
  }
  const unsigned cores = std::thread::hardware_concurrency();
  return fmt::format("{}, {} core{}", processor, cores, cores == 1 ? "" : "s");
}

}  // namespace nysalt::program
