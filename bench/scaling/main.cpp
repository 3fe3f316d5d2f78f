// SPDX-License-Identifier: BSL-1.0
// Under mpirun, a line of JSON a measurement on stdout:
//   nysalt_scaling times FOLDER               stepping, learning, writing; 1, 2, 4, ... and all ranks in turn
//   nysalt_scaling reductions                 one sum over all ranks
//   nysalt_scaling memory TRAJECTORIES STEPS  of each rank, for the data to learn from
#include <mpi.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "first_ranks.hpp"
#include "measure.hpp"

namespace {

using namespace nysalt::bench;

bool measure(const std::vector<std::string>& words) {
  if (words.size() == 2 && words[0] == "times") {
    measure_stepping();
    measure_learning();
    measure_writing(words[1]);
  } else if (words.size() == 1 && words[0] == "reductions") {
    measure_reductions();
  } else if (words.size() == 3 && words[0] == "memory") {
    measure_memory(std::stoll(words[1]), std::stoll(words[2]));
  } else {
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  int granted = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &granted);
  int code = 0;
  try {
    if (!measure({argv + 1, argv + argc})) {
      fmt::print(stderr, "usage: nysalt_scaling times FOLDER | reductions | memory TRAJECTORIES STEPS\n");
      code = 2;
    }
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_scaling: {}\n", problem.what());
    MPI_Abort(MPI_COMM_WORLD, 1);  // others may wait for it
  }
  MPI_Finalize();
  return code;
}
