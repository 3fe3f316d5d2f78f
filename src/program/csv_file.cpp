// SPDX-License-Identifier: BSL-1.0
#include "csv_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "comparison/inputs.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

/// Takes the first line, or the first cell of a line, off a text.
std::string_view take_up_to(char end, std::string_view& text) {
  const auto at = text.find(end);
  const auto taken = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return taken;
}

std::size_t columns_of(std::string_view line) {
  return static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
}

/// Of a line that is empty none.
void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  if (line.ends_with('\r')) line.remove_suffix(1);
  const bool is_last_empty = line.ends_with(',');
  while (!line.empty()) cells.push_back(take_up_to(',', line));
  if (is_last_empty) cells.emplace_back();
}

/// All of the file; it may be a device without end.
std::string contents_of(const std::string& option, const std::string& file) {
  constexpr std::streamsize most = std::streamsize{1} << 26U;  // bytes
  std::error_code ignored;
  std::ifstream input(file, std::ios::binary);
  std::string text;
  if (!std::filesystem::is_directory(file, ignored) && input) {
    const auto size = std::filesystem::file_size(file, ignored);
    const bool is_known = !ignored && size > 0 && size < static_cast<std::uintmax_t>(most);
    text.resize(is_known ? static_cast<std::size_t>(size) : static_cast<std::size_t>(most));
    input.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(input.gcount()));
    if (input && input.peek() != std::ifstream::traits_type::eof()) {
      refuse("{} {}: a table must be at most 64 MB long; take fewer lines", option, file);
    }
  }
  if (text.empty()) {
    refuse(
        "cannot read {} {}: the file is missing, empty or not readable; name a CSV file with a line of names",
        option, file);
  }
  return text;
}

constexpr std::size_t most_cells = std::size_t{1} << 22U;  // which take some hundred megabytes

/// Throws refusal for a table of more cells than are read.
void require_few_cells(const std::string& option, const std::string& file, std::size_t lines,
                       std::size_t columns) {
  if (lines * columns <= most_cells) return;
  refuse(
      "{} {}: a table must have at most 2^22 = {} cells, got {} in a line and {} lines or more; take fewer "
      "lines",
      option, file, most_cells, columns, lines);
}

}  // namespace

void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(std::size_t, const std::vector<std::string_view>&)>& row) {
  note_input(file);
  const std::string text = contents_of(option, file);
  std::string_view left = text;
  std::vector<std::string_view> cells;
  const auto first = take_up_to('\n', left);
  require_few_cells(option, file, 1, columns_of(first));
  split(first, cells);
  const std::vector<std::string> names(cells.begin(), cells.end());
  header(names);
  std::size_t rows = 1;
  for (std::size_t number = 2; !left.empty(); ++number) {
    const auto line = take_up_to('\n', left);
    if (line.empty() || line == "\r") continue;
    const auto columns = columns_of(line);
    if (columns != names.size()) {
      refuse("{} {}: line {} must have {} columns as the first line, got {}", option, file, number,
             names.size(), columns);
    }
    require_few_cells(option, file, ++rows, columns);
    split(line, cells);
    row(number, cells);
  }
}

}  // namespace nysalt::program
