// SPDX-License-Identifier: BSL-1.0
#include "csv_file.hpp"

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

}  // namespace

void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(std::size_t, const std::vector<std::string_view>&)>& row) {
  note_input(file);
  const std::string text = contents_of(option, file);
  std::string_view left = text;
  std::vector<std::string_view> cells;
  split(take_up_to('\n', left), cells);
  const std::vector<std::string> names(cells.begin(), cells.end());
  header(names);
  for (std::size_t number = 2; !left.empty(); ++number) {
    split(take_up_to('\n', left), cells);
    if (cells.empty()) continue;
    if (cells.size() != names.size()) {
      refuse("{} {}: line {} must have {} columns as the first line, got {}", option, file, number,
             names.size(), cells.size());
    }
    row(number, cells);
  }
}

}  // namespace nysalt::program
