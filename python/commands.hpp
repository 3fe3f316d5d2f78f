// SPDX-License-Identifier: BSL-1.0
// The program's commands for Python: by the same functions, hence with the same numbers.
#pragma once

#include <pybind11/pybind11.h>

namespace nysalt::python {

/// learn, compare, recommend, the list of what there is, and files of methods.
void add_commands(pybind11::module_& module);

/// run and integrate.
void add_trajectories(pybind11::module_& module);

}  // namespace nysalt::python
