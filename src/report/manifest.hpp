// SPDX-License-Identifier: BSL-1.0
// Files of results, and the manifests beside them that record what made them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "comparison/json.hpp"
#include "comparison/settings.hpp"
#include "plot.hpp"

namespace nysalt::program {

/// FILE.manifest.json.
std::filesystem::path manifest_of(std::filesystem::path file);

/// Of the program and the libraries in it, by name.
json versions();

/// FILE.manifest.json beside FILE: command, seed, versions, compiler, flags, time, and the members of `more`.
/// Without a command, as of callers of the library, there is no manifest.
void write_manifest(const std::filesystem::path& file, const common_settings& common, const json& more = {});

/// A whole file and its manifest.
void write_result(const std::filesystem::path& file, std::string_view text, const common_settings& common);

/// The pictures of a figure below a folder, with their manifests. Returns one sentence if gnuplot cannot
/// draw.
std::string write_pictures(const figure& picture, const std::filesystem::path& folder,
                           const common_settings& common);

}  // namespace nysalt::program
