// SPDX-License-Identifier: BSL-1.0
// Systems that files declare: nothing is loaded that was not named.
#pragma once

#include <string>
#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// What a file declares by NYSALT_SYSTEM: a shared library, or a source, which is compiled before, unless it
/// is as it was. Loaded once, and for as long as the program runs. Throws refusal if that cannot be: with the
/// first error of the compiler, for what is no library or declares nothing, and for one that was compiled for
/// another version, compiler or number of lanes.
const system_declaration& plugin_at(const std::string& path);

/// Those that are loaded, in their order.
std::vector<const system_declaration*> loaded_plugins();

}  // namespace nysalt::program
