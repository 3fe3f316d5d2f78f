// SPDX-License-Identifier: BSL-1.0
// Results on their way out: standard output, files, and the manifests beside them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "json.hpp"
#include "settings.hpp"

namespace nysalt::program {

/// Prints to standard output. Throws refusal if it cannot be written; a reader who went away is no error.
void print(std::string_view text);

/// FILE.manifest.json beside FILE: command, seed, versions, compiler, flags, time.
void write_manifest(const std::filesystem::path& file, const common_settings& common);

/// A whole file and its manifest.
void write_result(const std::filesystem::path& file, std::string_view text, const common_settings& common);

/// Throws refusal now if a file could not be written there later.
void require_writable(const std::filesystem::path& file);

/// The folder that a file is in.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// One line on standard error.
void warn(std::string_view text);

}  // namespace nysalt::program
