// SPDX-License-Identifier: BSL-1.0
#include "exit_while_computing.hpp"

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace nysalt::python {

namespace {

constinit std::atomic<int> computations = 0;

void leave(int status, void* /* none */) {
  if (computations == 0) return;
  std::fflush(stdout);
  std::fflush(stderr);
  _exit(status);
}

}  // namespace

under_way::under_way() { ++computations; }

under_way::~under_way() { --computations; }

void leave_from_computations() {
  // The handler that is registered last is called first: before the destructors of static objects that were
  // constructed during a call. Hence this late, when Python has ended.
  const auto register_the_last = [] { on_exit(leave, nullptr); };  // glibc's: atexit passes no status
  if (Py_AtExit(register_the_last) != 0) {
    throw pybind11::import_error(
        "cannot load nysalt: Python takes no more functions for its end (Py_AtExit)");
  }
}

}  // namespace nysalt::python
