// SPDX-License-Identifier: BSL-1.0
// 0 done, 2 bad input, 3 no result: every trajectory diverged, or the fit is not usable.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "../support/program.hpp"
#include "../support/sanitizers.hpp"

using namespace nysalt::test;

namespace {

// At z = 2.5 Verlet is unstable, and multiplies stiff motion by 4 in a step: from the law of fpu, whose
// energies are some 7, all are lost (by more than 7e3) after some 7 steps, and none after 2.
const std::string unstable = "run --method verlet --step 0.05 --trajectories 5";

// Both kicks in the middle of the step: Verlet again, unstable at z = 2.5, and nothing is left to learn.
const std::string unusable = " --fix b1=0.5 --fix beta1=0.25";

std::string lines(const std::string& text) {
  return fmt::format("{}", std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

BOOST_AUTO_TEST_CASE(bad_input_is_2_and_one_line) {
  for (const char* line : {"", "--json"}) {
    const auto done = run(std::string("run --system nowhere --method verlet --step 0.1 --horizon 1 ") + line);
    BOOST_TEST(done.code == 2);
    BOOST_TEST(done.out == "");
    BOOST_TEST(lines(done.err) == "1");
    for (const char* word : {"nowhere", "fpu", "oscillator", "linear_chain", "pendulum", "henon_heiles"})
      BOOST_TEST(done.err.find(word) != std::string::npos, word);
  }
}

// A limit of processes, which the superuser has not, counts threads too.
BOOST_AUTO_TEST_CASE(threads_that_the_system_does_not_start_are_one_line) {
  const scratch folder("no_threads");
  // Another user may not write counts of lines where they are collected.
  const std::string user =
      shell(folder, "[ \"$(id -u)\" = 0 ]").code == 0
          ? "LLVM_PROFILE_FILE=/dev/null setpriv --reuid=65534 --regid=65534 --clear-groups "
          : "";
  if (shell(folder, user + "prlimit --nproc=1 \"$nysalt\" --version").code != 0) {
    BOOST_TEST_MESSAGE("skipped: another user may not run the program");
    return;
  }
  for (const std::string line :
       {"run --method verlet --step 0.02 --horizon 1 --trajectories 64",
        "run --system phi4 --masses 1000000 --method verlet --step 0.02 --horizon 1 --observables energy",
        "compare --methods verlet,mclachlan2 --steps 0.02 --trajectories 64 --horizon 1",
        "sample --system linear_chain --length 1 --draws 10 --chains 64"}) {
    const auto done = shell(folder, user + "prlimit --nproc=1 \"$nysalt\" " + line + " --threads 8");
    BOOST_TEST(done.code == 2, line << ": " << done.err);
    BOOST_TEST(lines(done.err) == "1", done.err);
    BOOST_TEST(done.err.find("threads must be as many as the system starts, got 8") != std::string::npos,
               done.err);
    BOOST_TEST(shell(folder, user + "prlimit --nproc=1 \"$nysalt\" " + line + " --threads 1").code == 0);
  }
}

// Where some threads start and others do not: oneTBB starts threads from threads, where nothing would catch
// the exception. Without what tries the threads before, a third of these ended by SIGABRT.
BOOST_AUTO_TEST_CASE(some_threads_that_do_not_start_abort_nothing) {
  const scratch folder("few_threads");
  if (shell(folder, "[ \"$(id -u)\" = 0 ]").code != 0) {
    BOOST_TEST_MESSAGE("skipped: threads of other processes of the user would count");
    return;
  }
  // A user without other processes, who may write in the folder.
  const std::string user =
      "LLVM_PROFILE_FILE=/dev/null setpriv --reuid=70777 --regid=70777 --clear-groups prlimit --nproc=";
  if (shell(folder, "mkdir mine && chmod 777 mine && " + user + "64 \"$nysalt\" --version").code != 0) {
    BOOST_TEST_MESSAGE("skipped: another user may not run the program");
    return;
  }
  for (const std::string line :
       {"run --system pendulum --method verlet --step 0.01 --horizon 10 --output o.csv",
        "compare --methods verlet,mclachlan2 --steps 0.02 --horizon 1"}) {
    for (const int limit : {2, 3, 4, 6, 12}) {
      const auto done =
          shell(folder, "cd mine; rm -f *; " + user + std::to_string(limit) + " \"$nysalt\" " + line +
                            " --trajectories 64 --threads 8; code=$?; ls | grep part; exit $code");
      BOOST_TEST_CONTEXT(limit << " threads: " << line << ": " << done.err) {
        BOOST_TEST(done.code == (limit < 8 ? 2 : 0));
        if (limit < 8) BOOST_TEST(lines(done.err) == "1");
        BOOST_TEST(done.out.find(".part") == std::string::npos);
      }
    }
  }
}

// A thread that the system refuses though as many were started before, as where other processes took them.
BOOST_AUTO_TEST_CASE(the_next_thread_that_does_not_start_aborts_nothing) {
  if (under_thread_sanitizer || under_address_sanitizer) return;  // which have their own pthread_create
  const scratch folder("next_thread");
  std::ofstream(folder / "refuse.c") << R"(#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
static atomic_int calls;
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*), void* argument) {
  if (++calls > atoi(getenv("THREADS"))) return EAGAIN;
  int (*next)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) = dlsym(RTLD_NEXT, "pthread_create");
  return next(thread, attributes, start, argument);
}
)";
  BOOST_TEST_REQUIRE(shell(folder, "gcc -shared -fPIC -o refuse.so refuse.c").code == 0);
  bool is_met_by_one_of_others = false;
  for (const int threads : {0, 1, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14, 1000}) {
    const auto done =
        shell(folder, "THREADS=" + std::to_string(threads) +
                          " LD_PRELOAD=$PWD/refuse.so \"$nysalt\" run --system pendulum --method "
                          "verlet --step 0.01 --horizon 1000 --trajectories 64 --threads 8 --output o.csv");
    BOOST_TEST_CONTEXT(threads << " threads: " << done.err) {
      // Seven are tried; of others oneTBB starts, for each loop, as many as find work.
      BOOST_TEST((done.code == 2 || (done.code == 0 && threads > 7)));
      BOOST_TEST((done.code == 0 || threads < 1000));
      BOOST_TEST(lines(done.err) == (done.code == 2 ? "1" : "0"));
      is_met_by_one_of_others |= done.err.find("cannot start a thread") != std::string::npos;
      BOOST_TEST(!folder.files().contains("o.csv.new.part"));
    }
  }
  BOOST_TEST(is_met_by_one_of_others);
}

// What took the time is printed: the values that were learned with all digits, for each of several steps too.
BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_written_is_4_and_loses_no_result) {
  if (under_thread_sanitizer) return;  // which writes a file of its own before main() begins
  const scratch folder("full");
  const std::string learn = "learn --system henon_heiles --family bab2 --trajectories 8 --effort quick ";
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

// Without an output the draws are on the standard output and in the checkpoint alone.
BOOST_AUTO_TEST_CASE(draws_that_cannot_be_printed_stay_in_the_checkpoint) {
  if (!std::filesystem::is_character_file("/dev/full")) return;
  const scratch folder("kept");
  const std::string line =
      "sample --system gaussian --size 3 --length 1 --draws 20 --burn-in 100 --checkpoint c --every 50 "
      "--json";
  BOOST_TEST(shell(folder, "\"$nysalt\" " + line + " >/dev/full").code == 4);
  BOOST_TEST((folder.files() == std::set<std::string>{"c"}));
  BOOST_TEST(run(folder, line + " --resume").code == 0);
  BOOST_TEST(folder.files().empty());
}

BOOST_AUTO_TEST_CASE(a_run_of_which_all_diverged_is_3) {
  for (const auto& [horizon, code, diverged] : {std::tuple{"0.1", 0, 0U}, {"1", 3, 5U}}) {
    const auto done = run(unstable + " --json --horizon " + horizon);
    BOOST_TEST(done.code == code);
    BOOST_TEST(done.err == "");
    const auto all = json_of(done);
    BOOST_REQUIRE(all.is_object());
    BOOST_TEST(all["diverged"].size() == diverged);
    for (const auto& one : all["diverged"]) {
      const int step = one["step"];
      BOOST_TEST(one["t"] == step * 0.05);
      // What diverged is not shown.
      for (const auto& row : all["rows"]) BOOST_TEST((row[0] != one["trajectory"] || row[1] < step));
    }
    BOOST_REQUIRE(all["warnings"].size() == 1U);  // in either case: it is not stable
    BOOST_TEST(all["warnings"][0].get<std::string>().find("not linearly stable") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(a_run_of_which_some_diverged_is_0) {
  // One after another, until some have diverged and some have not.
  bool found = false;
  for (const char* horizon : {"0.15", "0.2", "0.25", "0.3"}) {
    const auto done =
        run("run --method verlet --step 0.05 --trajectories 40 --json --horizon " + std::string(horizon));
    const auto diverged = json_of(done)["diverged"].size();
    BOOST_TEST(done.code == (diverged == 40U ? 3 : 0));
    found = found || (0U < diverged && diverged < 40U);
  }
  BOOST_TEST(found);
}

BOOST_AUTO_TEST_CASE(for_people_the_diverged_are_told_on_standard_error) {
  const auto done = run(unstable + " --horizon 1");
  BOOST_TEST(done.code == 3);
  for (int m = 0; m < 5; ++m)
    BOOST_TEST(done.err.find(fmt::format("trajectory {} diverged at step ", m)) != std::string::npos);
  BOOST_TEST(done.out.starts_with("trajectory,step,t,stiff_energy\n"));
}

BOOST_AUTO_TEST_CASE(a_fit_that_is_not_usable_is_3) {
  const auto fixed =
      run("learn --loss state:1 --family nystrom --step 0.05 --trajectories 3 --json" + unusable);
  BOOST_TEST(fixed.code == 3);
  BOOST_TEST(json_of(fixed)["usable"] == false);
  BOOST_TEST(json_of(fixed)["reason"].get<std::string>().find("not linearly stable") != std::string::npos);
  BOOST_TEST(fixed.err.find("not linearly stable") != std::string::npos);
  // What is learned here errs so little that a reference which takes the large step itself is none.
  const std::string coarse = "learn --family fg_chin --step 0.045 --json --fine-step ";
  const auto at_once = run(coarse + "0.045");
  BOOST_TEST(at_once.code == 3);
  BOOST_TEST(json_of(at_once)["reason"].get<std::string>().find("the reference's own error") !=
             std::string::npos);
  const auto in_ten = run(coarse + "0.0045");
  BOOST_TEST(in_ten.code == 0);
  BOOST_TEST(json_of(in_ten)["reason"].is_null());
}

BOOST_AUTO_TEST_CASE(compare_is_3_only_if_no_row_has_an_error) {
  const auto code = [](const std::string& line) {
    const auto done =
        run("compare --trajectories 3 --learn-trajectories 3 --json --steps 0.05 --horizon 1 " + line);
    const auto all = json_of(done);
    BOOST_REQUIRE(all.is_object());
    bool any = false;
    for (const auto& row : all["rows"]) {
      const bool sound = row["error"].is_number();
      BOOST_TEST(row.contains("reason") == !sound);
      BOOST_TEST(row["evaluations_per_time"] > 0.0);
      any = any || sound;
      if (sound) continue;
      BOOST_TEST(row["error"].is_null());
      BOOST_TEST(row["standard_error"].is_null());
      const std::string expected = row["method"] == "verlet" ? "every trajectory diverged" : "not usable";
      BOOST_TEST(row["reason"].get<std::string>().find(expected) != std::string::npos);
      BOOST_TEST(row["diverged"] == (row["method"] == "verlet" ? 3 : 0));
    }
    BOOST_TEST(done.code == (any ? 0 : 3));
    BOOST_TEST(done.err == "");
    return done.code;
  };
  BOOST_TEST(code("--methods verlet") == 3);
  BOOST_TEST(code("--methods learned:nystrom" + unusable) == 3);
  BOOST_TEST(code("--methods verlet,learned:nystrom" + unusable) == 3);
  BOOST_TEST(code("--methods verlet,mclachlan2") == 0);
  BOOST_TEST(code("--methods learned:nystrom,bcss2" + unusable) == 0);
  BOOST_TEST(code("--methods learned:nystrom,verlet --learn-horizon 1") == 0);
}
