// SPDX-License-Identifier: BSL-1.0
// Files of results, and the manifest of their folder, which records what made each of them.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/settings.hpp"
#include "plot.hpp"

namespace nysalt::program {

/// manifest.json in the folder of a file.
std::filesystem::path manifest_of(const std::filesystem::path& file);

/// FILE.manifest.json, of one file, as earlier versions wrote.
std::filesystem::path earlier_manifest_of(std::filesystem::path file);

/// Entries of a manifest, by names of files; null for what is not whole, or no manifest of nysalt.
json entries_in(const std::filesystem::path& manifest);

/// Throws refusal if entries cannot be added in the folder of a file: its manifest.json is an input, a
/// folder, or not of nysalt, or the file itself has that name or one beside it, or is a link to one that has.
void require_manifest(const std::filesystem::path& file);

/// Of the program and the libraries in it, by name.
json versions();

/// Entries of files of one folder in its manifest: command, seed, versions, compiler, flags, time, and the
/// members of `more`. Entries of other files stay, also of other processes that write at the same time, for
/// which it waits up to `patience`. Without a command, as of callers of the library, there is no manifest.
void record_results(const std::vector<std::filesystem::path>& files, const common_settings& common,
                    const json& more = {}, std::chrono::milliseconds patience = std::chrono::minutes(1));

/// A whole file, which is not recorded yet.
void write_unrecorded(const std::filesystem::path& file, std::string_view text);

/// A whole file and its entry in the manifest.
void write_result(const std::filesystem::path& file, std::string_view text, const common_settings& common);

/// What is written of a figure of that name: pictures, script and data.
std::vector<std::filesystem::path> files_of_picture(const std::string& name,
                                                    const std::filesystem::path& folder);

/// Throws refusal if one of these cannot be written, as an input or no regular file has a name that is
/// needed.
void require_picture(const std::string& name, const std::filesystem::path& folder);

/// The same of every figure of which the folder has something.
void require_pictures(const std::filesystem::path& folder);

/// Removes pictures of the figure that an earlier version made, in the folder of the report, with their
/// manifests.
void remove_earlier_pictures(const figure& picture, const std::filesystem::path& folder);

/// The pictures of a figure below a folder, with their entries. Returns one sentence if gnuplot cannot draw.
std::string write_pictures(const figure& picture, const std::filesystem::path& folder,
                           const common_settings& common);

}  // namespace nysalt::program
