// SPDX-License-Identifier: BSL-1.0
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <string>

#include "races.hpp"

int main(int argc, char** argv) {
  using namespace nysalt::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("compiler", NYSALT_BENCH_COMPILER);
  benchmark::AddCustomContext("flags", NYSALT_BENCH_FLAGS);
  benchmark::AddCustomContext("l1_bytes", std::to_string(sysconf(_SC_LEVEL1_DCACHE_SIZE)));
  benchmark::AddCustomContext("l2_bytes", std::to_string(sysconf(_SC_LEVEL2_CACHE_SIZE)));
  benchmark::AddCustomContext("l3_bytes", std::to_string(sysconf(_SC_LEVEL3_CACHE_SIZE)));
  try {
    race_ensemble();
    race_single_trajectory();
    race_words();
    race_long_chain();
    race_liquid();
    race_growth();
    race_noise();
    race_langevin();
    race_heaviest_run();
    race_learning();
    race_learning_pass();
    race_threads();
    race_one_chain();
    race_compiling();
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "nysalt_races: %s\n", problem.what());
    return 1;
  }
  benchmark::Shutdown();
}
