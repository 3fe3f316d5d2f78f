// SPDX-License-Identifier: BSL-1.0
// The program on several ranks, as a shell starts them. For tests named *_on_ranks_test.cpp, which are built
// where there is MPI (NYSALT_MPIEXEC).
#pragma once

#include <sstream>
#include <string>

#include "program.hpp"

namespace nysalt::test {

/// "mpirun -n RANKS " for a line of shell(): for any user and any number of cores.
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

/// What ranks wrote to the standard error stream, without what the launcher tells of the machine: lines such
/// as
/// "[hwloc/linux] failed to find sysfs cpu topology", and banners, whose lines begin with stars.
inline std::string without_launcher(const std::string& err) {
  std::string kept;
  std::istringstream lines(err);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("[hwloc") && !line.starts_with("*")) kept += line + "\n";
  }
  return kept;
}

/// `mpirun -n RANKS nysalt arguments` in the folder; of the errors those of the program.
inline finished run_on(int ranks, const scratch& folder, const std::string& arguments) {
  finished done = shell(folder, on_ranks(ranks) + arguments);
  done.err = without_launcher(done.err);
  return done;
}

}  // namespace nysalt::test
