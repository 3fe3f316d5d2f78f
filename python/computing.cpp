// SPDX-License-Identifier: BSL-1.0
#include "computing.hpp"

#include <chrono>
#include <exception>
#include <future>
#include <thread>

#include "../src/comparison/progress.hpp"
#include "exit_while_computing.hpp"
#include "nysalt/core/rounding.hpp"

namespace nysalt::python {

namespace py = pybind11;

namespace {

/// ask(), of Python's C API, which throws nothing: what comes out of it is the end of this thread.
auto stay_at_the_end(const auto& ask, program::quiet_caller* caller = nullptr) {
  try {
    return ask();
  } catch (...) {  // to be thrown again by who leaves here
    if (caller != nullptr) caller->wants_an_end = true;
    while (true) std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

void compute_apart(const std::function<void()>& work) {
  program::quiet_caller caller;
  bool ends = false;
  auto done = std::async(std::launch::async, [&] {
    const program::work_for work_scope(caller);
    const nysalt::detail::usual_rounding rounding;
    work();
    rounding.require();
  });
  PyThreadState* const state = PyEval_SaveThread();
  const auto asked_for_signals = [&] {
    PyEval_RestoreThread(state);
    const bool raised = PyErr_CheckSignals() != 0;  // its exception waits in this thread
    PyEval_SaveThread();
    return raised;
  };
  while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
    if (ends) continue;
    ends = stay_at_the_end(asked_for_signals, &caller);
    caller.wants_an_end = ends;
  }
  stay_at_the_end([&] { PyEval_RestoreThread(state); });
  if (!ends) return done.get();
  done.wait();
  throw py::error_already_set();
}

}  // namespace

void compute(bool calls_python, const std::function<void()>& work) {
  const under_way here;
  if (!calls_python) return compute_apart(work);
  program::quiet_caller caller;
  const program::work_for work_scope(caller);
  const nysalt::detail::usual_rounding rounding;
  work();
  rounding.require();
}

void without_lock(const std::function<void()>& work) {
  const under_way here;
  std::exception_ptr thrown;
  PyThreadState* const state = PyEval_SaveThread();
  try {
    const nysalt::detail::usual_rounding rounding;
    work();
    rounding.require();
  } catch (...) {
    thrown = std::current_exception();
  }
  stay_at_the_end([&] { PyEval_RestoreThread(state); });
  if (thrown) std::rethrow_exception(thrown);
}

py::object called(const py::object& function, const py::tuple& arguments) {
  PyObject* const found =
      stay_at_the_end([&] { return PyObject_Call(function.ptr(), arguments.ptr(), nullptr); });
  if (found == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(found);
}

void require_no_signal() {
  if (stay_at_the_end([] { return PyErr_CheckSignals() != 0; })) throw py::error_already_set();
}

}  // namespace nysalt::python
