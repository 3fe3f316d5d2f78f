// SPDX-License-Identifier: BSL-1.0
// An ensemble of a Hamiltonian of Python as one system: one call of the force for all trajectories.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "nysalt/method.hpp"
#include "own_hamiltonian.hpp"

namespace nysalt::python {

/// Whether the functions take many states, and the letters move each trajectory by itself: an f'(q) v of
/// differences would be along all of them.
bool goes_together(const own_functions& functions, const nysalt::method& method);

/// Takes states to the end of a plan, with the bits of program::integrate() where the functions find the same
/// of many states as of one. Where a trajectory is lost, q and p become NaN.
void integrate_together(const std::shared_ptr<const own_functions>& functions, const bath& heat_bath,
                        const nysalt::method& method, const program::trajectories_plan& plan,
                        std::span<double> q, std::span<double> p);

}  // namespace nysalt::python
