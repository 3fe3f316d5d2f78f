// SPDX-License-Identifier: BSL-1.0
// Systems that shared objects offer by the functions of nysalt/c_force.h.
#pragma once

#include <string>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// Whether the library, a handle of dlopen(), has nysalt_force.
bool has_c_force(void* library);

/// The system of a library that has it. Throws refusal, naming the file as `shown`, for a function that is
/// missing, and for an invalid dimension or mass. The library must stay loaded.
system_declaration declaration_of_c_force(void* library, const std::string& path, const std::string& shown);

}  // namespace nysalt::program
