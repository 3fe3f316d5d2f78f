// SPDX-License-Identifier: BSL-1.0
#include "computing.hpp"

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <future>

#include "../src/progress.hpp"

namespace nysalt::python {

namespace {

void compute_apart(const std::function<void()>& work) {
  program::quiet_caller caller;
  bool is_interrupted = false;
  auto done = std::async(std::launch::async, [&] {
    const program::work_for its(caller);
    work();
  });
  {
    const pybind11::gil_scoped_release released;
    while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      if (is_interrupted) continue;
      const pybind11::gil_scoped_acquire held;
      is_interrupted = PyErr_CheckSignals() != 0;  // its exception waits in this thread
      caller.wants_an_end = is_interrupted;
    }
  }
  if (!is_interrupted) return done.get();
  done.wait();
  throw pybind11::error_already_set();
}

}  // namespace

void compute(bool calls_python, const std::function<void()>& work) {
  if (!calls_python) return compute_apart(work);
  program::quiet_caller caller;
  const program::work_for its(caller);
  work();
}

}  // namespace nysalt::python
