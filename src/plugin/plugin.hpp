// SPDX-License-Identifier: BSL-1.0
// Systems that files declare: nothing is loaded that was not named.
#pragma once

#include <string>
#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// The declaration, by NYSALT_SYSTEM, in a shared library or in a source, which is compiled unless nothing
/// has changed, and stays loaded until the program ends. A file that has changed since is another system; the
/// declaration of before is as it was. Thread-safe. Messages name the file as `shown`, or by its path if that
/// is empty. Throws refusal with the first error of the compiler, for a file that is no library or declares
/// nothing, and for a library that was compiled for another version, compiler or number of lanes.
const system_declaration& plugin_at(const std::string& path, const std::string& shown = "");

/// Those that are loaded, in their order.
std::vector<const system_declaration*> loaded_plugins();

}  // namespace nysalt::program
