// SPDX-License-Identifier: BSL-1.0
// Threads that the system does not start.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

/// Lines of a shell that begin a command as a user without other processes, whose threads would count, with
/// at most so many processes. Another user may not write counts of lines where they are collected. Empty
/// where that cannot be.
std::string limited(const scratch& folder, int processes) {
  const std::string user = shell(folder, "[ \"$(id -u)\" = 0 ]").code == 0
                               ? "setpriv --reuid=70777 --regid=70777 --clear-groups "
                               : "";
  const std::string line = "LLVM_PROFILE_FILE=/dev/null " + user + "prlimit --nproc=";
  const bool can_be =
      shell(folder, "mkdir -p mine && chmod 777 mine && " + line + "64 \"$nysalt\" --version").code == 0;
  return can_be && (processes == 1 || !user.empty()) ? line + std::to_string(processes) + " \"$nysalt\" "
                                                     : "";
}

}  // namespace

// A limit of processes, which the superuser has not, counts threads too. Where some threads start and others
// do not, oneTBB starts threads from threads, where nothing would catch the exception: without what tries the
// threads before, a third of these ended by SIGABRT.
BOOST_AUTO_TEST_CASE(threads_that_the_system_does_not_start_are_one_line) {
  const scratch folder("few_threads");
  for (const int limit : {1, 2, 3, 6, 12}) {
    const std::string user = limited(folder, limit);
    if (user.empty()) continue;
    for (const std::string line :
         {"run --system pendulum --method verlet --step 0.01 --horizon 10 --output o.csv --trajectories 64",
          "run --system phi4 --masses 100000 --method verlet --step 0.02 --horizon 0.2 --observables energy",
          "compare --methods verlet,mclachlan2 --steps 0.02 --trajectories 64 --horizon 1",
          "sample --system linear_chain --length 1 --draws 10 --chains 64"}) {
      const auto done = shell(folder, "cd mine; rm -f *; " + user + line +
                                          " --threads 8 >../out; code=$?; ls | grep part; exit $code");
      BOOST_TEST_CONTEXT(limit << " threads: " << line << ": " << done.err) {
        BOOST_TEST(done.code == (limit < 8 ? 2 : 0));
        BOOST_TEST(std::ranges::count(done.err, '\n') == (limit < 8 ? 1 : 0));
        BOOST_TEST(done.out.empty());  // no .part is left
        if (limit == 1) {
          BOOST_TEST(done.err.find("threads must be as many as the system starts, got 8") !=
                     std::string::npos);
          BOOST_TEST(shell(folder, "cd mine; " + user + line + " --threads 1").code == 0);
        }
      }
    }
  }
}
