// SPDX-License-Identifier: BSL-1.0
// Long computations, which Ctrl-C ends.
#pragma once

#include <functional>

namespace nysalt::python {

/// Work that calls no function of Python is done on a thread of its own, without the interpreter's lock:
/// other threads of Python run, and this one asks for signals fifty times a second. What a signal handler
/// raises (KeyboardInterrupt) is raised when the work has come to a place where it can end: the next block of
/// trajectories, stretch of steps, or pass over the data.
/// Work that does call Python is done here, with the lock; its functions ask for signals.
void compute(bool calls_python, const std::function<void()>& work);

}  // namespace nysalt::python
