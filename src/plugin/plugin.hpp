// SPDX-License-Identifier: BSL-1.0
// Systems that files declare: nothing is loaded that was not named.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// What a file declares by NYSALT_SYSTEM: a shared library, or a source, which is compiled before, unless it
/// is as it was. Loaded once, and for as long as the program runs. Throws refusal if that cannot be: with the
/// first error of the compiler, for what is no library or declares nothing, and for one that was compiled for
/// another version, compiler or number of lanes.
/// Messages call it as `shown` says; empty: by its path.
const system_declaration& plugin_at(const std::string& path, const std::string& shown = "");
/// Throws as plugin_at() does for what a library holds, and keeps nothing.
void require_plugin(const std::string& path, const std::string& shown);

/// Lower-case letters, digits and _, a letter first.
bool is_plain_name(std::string_view name);
/// What no parameter may be called: files, options and arguments of Python hold other things by these names.
bool is_reserved_name(std::string_view name);

/// Those that are loaded, in their order.
std::vector<const system_declaration*> loaded_plugins();

}  // namespace nysalt::program
