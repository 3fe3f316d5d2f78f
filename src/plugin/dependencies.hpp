// SPDX-License-Identifier: BSL-1.0
// What a source is made of: itself, and every file that the compiler reads for it but those of the system and
// of nysalt.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recipe.hpp"

namespace nysalt::program {

using dependencies = std::vector<std::filesystem::path>;  // the source first

/// Asks the compiler. Throws refusal with the first error of the compiler. Cost: about a second.
dependencies dependencies_of(const std::filesystem::path& source, const recipe& how);

/// The contents of the files, in their order. Throws refusal if one cannot be read.
std::string contents_of(const dependencies& files);

/// What the environment adds to the arguments of a compiler.
std::string environment_of_compiler();

/// The answer of dependencies_of(), kept in a file of the cache for the next process, with the name of the
/// library that was made of these contents.
struct kept_dependencies {
  dependencies files;
  std::string library;
};
/// Nothing if there is no such file, if one of the files is gone, or if a file of the same name lies now
/// where the compiler looks first.
std::optional<kept_dependencies> dependencies_kept_in(const std::filesystem::path& file,
                                                      const std::filesystem::path& source);
void keep_dependencies(const std::filesystem::path& file, const kept_dependencies& found);

/// The message to show of all that a compiler wrote: a sentence of nysalt's if there is one, else the first
/// error.
std::string first_error(const std::string& messages);

}  // namespace nysalt::program
