// SPDX-License-Identifier: BSL-1.0
// What a first example costs to compile, with the learner and without: nobody pays for Ceres who does not
// learn.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "races.hpp"

namespace nysalt::bench {

namespace {

runner compiling(const std::string& name, const std::string& source) {
  const std::string command = std::string(NYSALT_BENCH_COMPILE) + " -c -o /dev/null '" + source + "'";
  return {name, 1.0, [command, name] {
            if (std::system(command.c_str()) != 0)
              throw std::runtime_error("what is compiled " + name + " does not compile");
          }};
}

}  // namespace

void race_compiling() {
  std::vector<runner> runners;
  runners.push_back(compiling("with learner", NYSALT_SOURCE_DIR "/examples/first_steps.cpp"));
  runners.push_back(
      compiling("without learner", NYSALT_SOURCE_DIR "/bench/compile_time/without_learner.cpp"));
  race("compiling", std::move(runners),
       {.turn_seconds = 0.0, .repetitions = 1, .clock = clock_kind::children});
}

}  // namespace nysalt::bench
