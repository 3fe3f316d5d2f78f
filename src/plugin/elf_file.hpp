// SPDX-License-Identifier: BSL-1.0
// What a shared library says of itself, before it is loaded.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace nysalt::program {

/// Whether all of the file that the loader would map is there; of one that was cut off the first use of what
/// is missing would end the process. What is no library of this machine the loader refuses itself.
bool is_whole(const std::filesystem::path& file);

/// Symbols that the loader binds once in a process, to the first library that has them (STB_GNU_UNIQUE): what
/// g++ makes of inline variables and of static members of templates. Symbols of the C++ library, Eigen,
/// Boost and fmt are left out.
std::set<std::string> unique_symbols_of(const std::filesystem::path& file);

}  // namespace nysalt::program
