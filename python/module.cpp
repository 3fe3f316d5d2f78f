// SPDX-License-Identifier: BSL-1.0
#include <pybind11/pybind11.h>

#include "commands.hpp"
#include "exit_while_computing.hpp"
#include "refused.hpp"
#include "systems.hpp"

/// The functions on which nysalt/__init__.py is built. Its arguments are those of the program, in a dict;
/// documents are JSON.
PYBIND11_MODULE(_nysalt, module) {
  nysalt::python::leave_from_computations();
  nysalt::python::raise_refusals();
  nysalt::python::add_systems(module);
  nysalt::python::add_commands(module);
  nysalt::python::add_trajectories(module);
}
