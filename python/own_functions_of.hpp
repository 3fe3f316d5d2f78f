// SPDX-License-Identifier: BSL-1.0
// Functions of Python as those of a Hamiltonian.
#pragma once

#include "arguments.hpp"
#include "own_hamiltonian.hpp"

namespace nysalt::python {

/// Held by one owner only, which shows them to Python's collector: they may hold the system in turn.
struct functions_of_python {
  pybind11::object potential;
  pybind11::object force;
  pybind11::object starts;
  bool may_overflow = false;  // since they were examined at some starts
};

/// Of the arguments name, dimension, potential, force, starts, inverse_mass and frequency. Throws refusal for
/// bad values. What the functions raise is raised by their caller, and what they return in another
/// shape, or what is no real number, is refused. Where they may overflow, an OverflowError or a
/// FloatingPointError is NaN, and a trajectory diverges there.
own_functions own_functions_of(const argument_reader& arguments, std::shared_ptr<functions_of_python>& kept);

}  // namespace nysalt::python
