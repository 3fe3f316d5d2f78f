// SPDX-License-Identifier: BSL-1.0
// Compiles what users write into what the program loads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nysalt::program {

/// A path that is compiled before it is loaded.
bool is_source(std::string_view path);

/// The shared library of a source, in the user's cache: compiled unless the source, what the compiler read
/// for it, the library and its flags are as they were. Throws refusal with the first error of the compiler,
/// and if there is no compiler, or no development files of nysalt. Cost: some five seconds.
std::filesystem::path compiled(const std::filesystem::path& source);

/// A source that was made, as a file in the user's cache. Throws refusal if it cannot be written.
std::filesystem::path kept_source(const std::string& text);

/// Where the library of a source goes: the output, or if that is empty ./SOURCE.so; the path has a slash in
/// it. Throws refusal for other endings than .hpp and .so.
std::string library_of(const std::string& source, const std::string& output);

/// The library as a file there, which is replaced as a whole; a link is followed. Returns the path.
std::string build_library(const std::string& source, const std::string& output);

}  // namespace nysalt::program
