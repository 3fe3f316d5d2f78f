// SPDX-License-Identifier: BSL-1.0
#include "csv_file.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

std::vector<std::string> cells_of(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}

}  // namespace

void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(std::size_t, const std::vector<std::string>&)>& row) {
  std::error_code ignored;
  note_input(file);
  std::ifstream input(file);
  std::string line;
  if (std::filesystem::is_directory(file, ignored) || !input || !std::getline(input, line)) {
    refuse("{} {}: it cannot be read, or is empty; name a CSV file with a line of names", option, file);
  }
  const auto names = cells_of(line);
  header(names);
  for (std::size_t number = 2; std::getline(input, line); ++number) {
    const auto cells = cells_of(line);
    if (cells.empty()) continue;
    if (cells.size() != names.size()) {
      refuse("{} {}: line {} must have {} columns as the first line, got {}", option, file, number,
             names.size(), cells.size());
    }
    row(number, cells);
  }
}

}  // namespace nysalt::program
