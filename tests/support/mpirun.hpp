// SPDX-License-Identifier: BSL-1.0
// The program on several ranks, as a shell starts them. For tests named *_on_ranks_test.cpp, which are built
// where there is MPI (NYSALT_MPIEXEC).
#pragma once

#include <string>

#include "program.hpp"

namespace nysalt::test {

/// "mpirun -n RANKS " for a line of shell(): whoever tests, on however few cores.
inline std::string mpirun(int ranks) {
  std::string line = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 ";
  line += "OMPI_MCA_btl_vader_single_copy_mechanism=none ";
  line += "'" NYSALT_MPIEXEC "' --oversubscribe --bind-to none -n ";
  line += std::to_string(ranks) + " ";
  return line;
}

/// "mpirun -n RANKS $nysalt "
inline std::string on_ranks(int ranks) { return mpirun(ranks) + "\"$nysalt\" "; }

/// "mpirun -n RANKS $nysalt arguments", where rank r leaves the number of its process in the file pid.r.
inline std::string on_known_ranks(int ranks, const std::string& arguments) {
  std::string line = mpirun(ranks) + "sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$nysalt\" ";
  line += arguments;
  line += "'";
  return line;
}

/// `mpirun -n RANKS nysalt arguments` in the folder.
inline finished run_on(int ranks, const scratch& folder, const std::string& arguments) {
  return shell(folder, on_ranks(ranks) + arguments);
}

}  // namespace nysalt::test
