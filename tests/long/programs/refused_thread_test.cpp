// SPDX-License-Identifier: BSL-1.0
// Threads that are refused in the midst of others. Tier 1 has limits of processes in
// tests/programs/few_threads_test.cpp.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <fstream>
#include <string>

#include "../../support/program.hpp"
#include "../../support/sanitizers.hpp"

using namespace nysalt::test;

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
      BOOST_TEST(std::ranges::count(done.err, '\n') == (done.code == 2 ? 1 : 0));
      is_met_by_one_of_others |= done.err.find("cannot start a thread") != std::string::npos;
      BOOST_TEST(!folder.files().contains("o.csv.new.part"));
    }
  }
  BOOST_TEST(is_met_by_one_of_others);
}
