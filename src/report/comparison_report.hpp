// SPDX-License-Identifier: BSL-1.0
// Reports of a comparison: on a terminal, as JSON, and on a page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparison/comparison.hpp"
#include "terminal.hpp"

namespace nysalt::program {

/// The results of a comparison for machines, and for people.
json document_of(const comparison& all);
json schema_of_comparison();
/// First who is best, then the rows by rank; details where they are asked for.
std::string readable(const comparison& all, const text_form& form = {});
/// In the folder of a report.
constexpr const char* folder_of_schemes = "schemes";
constexpr const char* work_of_report = "report.work";  // of finished parts, until the report is written
/// Report and tables in a folder, and the schemes of learned rows in one below. Returns warnings of pictures
/// that could not be drawn.
std::vector<std::string> write_report(const comparison& all, const std::filesystem::path& folder);
/// Every row by every metric.
std::string csv_of(const comparison& all);

}  // namespace nysalt::program
