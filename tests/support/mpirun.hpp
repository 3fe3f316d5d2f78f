// SPDX-License-Identifier: BSL-1.0
// The program on several ranks, as a shell starts them. For tests named on_ranks_test.cpp, which are built
// where there is MPI (NYSALT_MPIEXEC).
#pragma once

#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

namespace nysalt::test {

/// "mpirun -n RANKS " for a line of shell(): for any user and any number of cores.
inline std::string mpirun(int ranks) {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
         "OMPI_MCA_btl_vader_single_copy_mechanism=none '" NYSALT_MPIEXEC
         "' --oversubscribe --bind-to none -n " +
         std::to_string(ranks) + " ";
}

/// "mpirun -n RANKS $nysalt "
inline std::string on_ranks(int ranks) { return mpirun(ranks) + "\"$nysalt\" "; }

/// "mpirun -n RANKS $nysalt arguments", where rank r leaves the number of its process in the file pid.r.
inline std::string on_known_ranks(int ranks, const std::string& arguments) {
  return mpirun(ranks) + "sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$nysalt\" " + arguments + "'";
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

/// `mpirun -n RANKS nysalt arguments` in the folder, or on 0 ranks without mpirun; of the errors those of the
/// program.
inline finished run_on(int ranks, const scratch& folder, const std::string& arguments) {
  if (ranks == 0) return run(folder, arguments);
  finished done = shell(folder, on_ranks(ranks) + arguments);
  done.err = without_launcher(done.err);
  return done;
}

/// Lines of the program's own on standard error: a refusal is one.
inline int sentences_in(const std::string& err) {
  int count = 0;
  for (auto at = err.find("nysalt: "); at != std::string::npos; at = err.find("nysalt: ", at + 1)) ++count;
  return count;
}

struct ranks_of_threads {
  int ranks;
  int threads;
};

/// A command whose document and files are to be the same on all of those ranks.
struct shared_command {
  std::string line;
  std::string output;  // a file, or none
  std::vector<ranks_of_threads> all;
  int code = 0;
};

/// The document and the output of one process on one thread come out on all ranks, and other ones with
/// another seed.
inline void ranks_change_no_byte(const shared_command& command) {
  const auto outcome = [&](const ranks_of_threads& by, const std::string& more) {
    const scratch folder("ranks");
    const std::string options = " --json --threads " + std::to_string(by.threads) + more +
                                (command.output.empty() ? "" : " --output " + command.output);
    const auto done = run_on(by.ranks, folder, command.line + options);
    BOOST_TEST_REQUIRE(done.code == command.code, done.err);
    BOOST_TEST(!json_of(done).is_discarded());  // one document, not one a rank
    return without_times(done.out) +
           (command.output.empty() ? "" : without_times(contents(folder / command.output)));
  };
  const std::string expected = outcome({0, 1}, "");
  BOOST_TEST(expected.size() > 100U);
  BOOST_TEST((outcome({0, 1}, " --seed 2") != expected), command.line);
  for (const auto& by : command.all) {
    BOOST_TEST_CONTEXT(command.line << " on " << by.ranks << " ranks of " << by.threads << " threads")
    BOOST_TEST((outcome(by, "") == expected));
  }
}

}  // namespace nysalt::test
