// SPDX-License-Identifier: BSL-1.0
// Checks of a system that a user declares, before any command works with it.
#pragma once

#include <string>
#include <string_view>

#include "examination.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// Lower-case letters, digits and _, a letter first.
bool is_plain_name(std::string_view name);

/// Checks the names of observables, and energy and force at four starts: both must be finite, and the force
/// -grad V (up to 2000 coordinates). Finds the frequency along 64 starts, of more than 64 coordinates fewer,
/// where none is declared. Throws refusal. Cost: some hundred forces a coordinate.
void examine(initial_value_problem& made, const std::string& name, examination how = examination::whole);

}  // namespace nysalt::program
