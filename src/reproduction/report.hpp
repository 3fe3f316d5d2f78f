// SPDX-License-Identifier: BSL-1.0
// Verdicts on the paper's claims, as a page, as JSON and as a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "comparison/json.hpp"
#include "comparison/settings.hpp"
#include "exhibit.hpp"

namespace nysalt::program::paper {

/// In the folder of a report.
constexpr const char* folder_of_pictures = "paper";

struct finished_part {
  std::string name;
  std::string title;
  std::vector<exhibit> exhibits;
};

class reproduction_report {
 public:
  reproduction_report(std::vector<finished_part> parts, bool quick, const common_settings& common);

  json document() const;
  /// Claim, ours, verdict of each finding, a line each.
  std::string summary() const;
  /// paper.md, paper.html and paper.json, and the pictures with scripts and data in paper/.
  void write(const std::filesystem::path& folder) const;

 private:
  std::vector<finished_part> parts_;
  bool quick_;
  common_settings common_;
};

}  // namespace nysalt::program::paper
