// SPDX-License-Identifier: BSL-1.0
// 0 done, 2 bad input, 3 no result, 4 not written; and threads that the system does not start.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>

#include "../support/program.hpp"
#include "../support/sanitizers.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(exit_codes) { run_table("exit_codes"); }

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

// What took the time is printed: the values that were learned with all digits, for each of several steps too.
BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_written_is_4_and_loses_no_result) {
  if (under_thread_sanitizer) return;  // which writes a file of its own before main() begins
  const scratch folder("full");
  const std::string learn =
      "learn --system henon_heiles --family bab2 --trajectories 8 --horizon 2 --effort quick ";
  const std::string sample = "sample --system linear_chain --length 1 --draws 100 ";
  // No file may have a byte, so that streams are pipes; counts of lines go elsewhere.
  const auto full = [&](const std::string& arguments, const std::string& reader = "cat") {
    return shell(folder, "export LLVM_PROFILE_FILE=/dev/null; { { ulimit -f 0; \"$nysalt\" " + arguments +
                             " --output o; echo \"code $?\" >&2; } 2>&1 >&3 | cat >&2; } 3>&1 | " + reader);
  };
  for (const auto& [arguments, values, member] :
       {std::tuple{learn + "--step 0.3", "held-out loss", "/parameters"},
        {learn + "--steps 0.2,0.3", "held-out loss", "/fits/1/parameters"},
        {sample, "potential", "/scalars"}}) {
    const auto whole = run(folder, arguments + " --json");
    BOOST_TEST_REQUIRE(whole.code == 0, whole.err);
    const auto done = full(arguments);
    BOOST_TEST(done.out.find(values) != std::string::npos, done.out);
    BOOST_TEST(done.out.find("Written") == std::string::npos);
    BOOST_TEST(done.err.find("cannot write o") != std::string::npos, done.err);
    BOOST_TEST(done.err.find("code 4") != std::string::npos, done.err);
    const auto document = json_of(full(arguments + " --json"));
    BOOST_REQUIRE(document.is_object());
    const nlohmann::ordered_json::json_pointer found(member);
    BOOST_TEST_REQUIRE(document.contains(found));
    BOOST_TEST(document[found] == json_of(whole)[found]);
    BOOST_TEST((!document.contains("output") || document["output"].is_null()));
    BOOST_TEST(!std::filesystem::exists(folder / "o"));
  }
  // A reader who leaves does not hide that.
  const auto left = full(sample, "true");
  BOOST_TEST(left.err.find("code 4") != std::string::npos, left.err);
}
