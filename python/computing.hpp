// SPDX-License-Identifier: BSL-1.0
// Long computations, which Ctrl-C ends, and the interpreter's lock. A thread that wants the lock while Python
// ends gets no answer: Python would end it by unwinding its stack, on which there are objects of Python and
// functions that let nothing through. It stays here instead, until the process is gone.
// All work rounds to nearest and keeps subnormal numbers, whatever other modules have set.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "nysalt/core/rounding.hpp"

namespace nysalt::python {

/// Of a function of the module: its arguments and results are read and written with the rounding of its work.
using rounded_as_usual = pybind11::call_guard<nysalt::detail::usual_rounding>;

/// Work that calls no function of Python is done on a thread of its own, without the interpreter's lock:
/// other threads of Python run, and this one asks for signals fifty times a second. What a signal handler
/// raises (KeyboardInterrupt) is raised when the work has come to a place where it can end: the next block of
/// trajectories, interval of steps, or pass over the data. A signal that comes meanwhile waits.
/// Work that does call Python is done here, with the lock; its functions ask for signals.
void compute(bool calls_python, const std::function<void()>& work);

/// Work of moments that calls no function of Python: here, without the lock.
void without_lock(const std::function<void()>& work);

/// The result of a function of Python. Throws what it raises.
pybind11::object called(const pybind11::object& function, const pybind11::tuple& arguments);

/// Throws what a signal handler raises, if there is a signal.
void require_no_signal();

}  // namespace nysalt::python
