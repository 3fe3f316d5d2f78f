// SPDX-License-Identifier: BSL-1.0
// Refusals as exceptions of Python.
#pragma once

#include <pybind11/pybind11.h>

namespace nysalt::python {

/// Whether what an argument raised says that it is of another kind (TypeError, ValueError, OverflowError).
/// Anything else is of the user's code, as KeyboardInterrupt and MemoryError are, and comes through.
bool says_not_convertible(const pybind11::error_already_set& raised);

/// Refusals of the library and the program name arguments, and are a ValueError, once this was called; what
/// fails on the way is a RuntimeError.
void raise_refusals();

}  // namespace nysalt::python
