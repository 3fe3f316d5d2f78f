// SPDX-License-Identifier: BSL-1.0
// Functions of Python as those of a Hamiltonian.
#pragma once

#include "given.hpp"
#include "own_hamiltonian.hpp"

namespace nysalt::python {

/// Of the arguments name, dimension, potential, force, starts, inverse_mass and frequency. Throws refusal for
/// what cannot be. What the functions raise is raised by whoever calls them, and what they return in another
/// shape is refused.
own_functions own_functions_of(const given& arguments);

}  // namespace nysalt::python
