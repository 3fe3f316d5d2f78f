// SPDX-License-Identifier: BSL-1.0
// Compiles what users write into what the program loads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nysalt::program {

/// A path that is compiled before it is loaded.
bool is_source(std::string_view path);

/// The shared library of a source, in the user's cache: compiled unless the source, what it includes in
/// quotes, the library and its flags are as they were. Throws refusal with the first error of the compiler,
/// and if there is no compiler, or no development files of nysalt. Cost: some five seconds.
std::filesystem::path compiled(const std::filesystem::path& source);

/// A source that was made, as a file in the user's cache. Throws refusal if it cannot be written.
std::filesystem::path kept_source(const std::string& text);

/// The same as a file of its own, which is replaced as a whole: the output, or if that is empty ./SOURCE.so.
/// Returns its path, which has a slash in it.
std::string build_library(const std::string& source, const std::string& output);

}  // namespace nysalt::program
