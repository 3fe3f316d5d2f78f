// SPDX-License-Identifier: BSL-1.0
// Files of results, which say themselves how they were made.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/settings.hpp"
#include "plot.hpp"

namespace nysalt::program {

/// Of the program and the libraries in it, by name.
json versions();

/// What the data of a command say of themselves first: the format, and versions as versions() has them.
json written_by(const char* format);

/// How a result was made: command, options, seed, versions, compiler, flags and time. Null without a command,
/// as of callers of the library.
json provenance_of(const common_settings& common);

/// Of options that were given, a line each, those that decide what is computed.
std::string deciding_options(const std::string& options);

/// What the first line of a table begins with, before JSON.
constexpr std::string_view mark_of_table = "# nysalt ";
/// The first line of a table, which says how it was made.
std::string first_line_of_table(const json& made);

/// A whole file.
void write_result(const std::filesystem::path& file, std::string_view text);
/// The same of a document, with its provenance.
void write_document(const std::filesystem::path& file, json document, const common_settings& common);
/// The same of a table: without what differs where the same work is done again, or gone on with.
void write_table(const std::filesystem::path& file, const std::string& rows, const common_settings& common);

/// What is written of a figure of that name: pictures, script and data.
std::vector<std::filesystem::path> files_of_picture(const std::string& name,
                                                    const std::filesystem::path& folder);

/// Throws refusal if one of these cannot be written, as an input or no regular file has a name that is
/// needed.
void require_picture(const std::string& name, const std::filesystem::path& folder);

/// The pictures of a figure in a folder. Returns one sentence if gnuplot cannot draw.
std::string write_pictures(const figure& picture, const std::filesystem::path& folder);

}  // namespace nysalt::program
