// SPDX-License-Identifier: BSL-1.0
#include "csv_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "comparison/inputs.hpp"
#include "comparison/number.hpp"
#include "comparison/refusal.hpp"
#include "report/result_file.hpp"

namespace nysalt::program {

namespace {

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
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    refuse(
        "cannot read {} {}: the file is missing, empty or not readable; name a CSV file with a line of names",
        option, file);
  }
  return text;
}

constexpr std::size_t most_cells = std::size_t{1} << 22U;  // which take some hundred megabytes

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Name in a cell, in which two quotes stand for one.
std::string name_in(std::string_view cell) {
  std::string name;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    name += cell[i];
    if (cell.substr(i, 2) == "\"\"") ++i;
  }
  return name;
}

/// The one that is most frequent outside of quotes; commas before others.
char separator_of(std::string_view line) {
  constexpr std::string_view known = ",;\t";
  std::array<std::ptrdiff_t, known.size()> counts{};
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    const auto which = known.find(c);
    if (!is_quoted && which != std::string_view::npos) ++counts.at(which);
  }
  return known[static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin())];
}

/// What pandas calls a column without a name.
bool is_unnamed(const std::string& name) { return name.empty() || name.starts_with("Unnamed: "); }

}  // namespace

class csv_reader {
 public:
  csv_reader(const std::string& option, const std::string& file)
      : where_(fmt::format("{} {}", option, file)), text_(contents_of(option, file)), left_(text_) {
    constexpr std::string_view mark = "\xef\xbb\xbf";  // of UTF-8
    if (left_.starts_with(mark)) left_.remove_prefix(mark.size());
    if (left_.starts_with("\xff\xfe") || left_.starts_with("\xfe\xff")) {
      refuse("{}: the file must be in UTF-8, got UTF-16; save it as CSV in UTF-8", where_);
    }
  }

  void read(const std::function<void(const std::vector<std::string>&)>& header,
            const std::function<void(csv_row&)>& row) {
    std::string_view line = next_line();
    const char separator = separator_of(line);
    csv_row cells(where_, names_, separator);
    split(line, cells);
    require_few_cells(1, columns_);
    for (const auto cell : cells.cells_) names_.push_back(name_in(cell));
    require_sound_names();
    header(names_);
    for (std::size_t rows = 2; !(line = next_line()).empty(); ++rows) {
      split(line, cells);
      if (columns_ != names_.size()) {
        const bool is_numbered = columns_ == names_.size() + 1;
        refuse("{}: line {} must have {} columns as the first line, got {}{}", where_, number_, names_.size(),
               columns_, is_numbered ? "; if it begins with a row number, leave these away" : "");
      }
      require_few_cells(rows, columns_);
      cells.line_ = number_;
      row(cells);
    }
  }

 private:
  /// The next line that is not blank, nor says how the table was made; empty at the end. Lines end with LF,
  /// CR LF or CR.
  std::string_view next_line() {
    while (!left_.empty()) {
      const auto end = std::min(left_.find_first_of("\n\r"), left_.size());
      const auto line = left_.substr(0, end);
      left_.remove_prefix(std::min(left_.size(), end + (left_.substr(end, 2) == "\r\n" ? 2 : 1)));
      ++number_;
      if (!trimmed(line).empty() && !line.starts_with(mark_of_table)) return line;
    }
    return {};
  }

  /// The cells of a line; no more are kept than a table may have, nor than one more than it has.
  void split(std::string_view line, csv_row& into) {
    const std::size_t most = names_.empty() ? most_cells : names_.size() + 1;
    into.cells_.clear();
    columns_ = 0;
    for (bool is_last = false; !is_last;) {
      auto end = line.find(into.separator_);
      const auto first = line.find_first_not_of(into.separator_ == '\t' ? " " : " \t");
      std::string_view cell;
      if (first < end && line[first] == '"') {
        auto close = line.find('"', first + 1);
        while (close < line.size() && line.substr(close, 2) == "\"\"") close = line.find('"', close + 2);
        end = line.find(into.separator_, std::min(close, line.size()));
        if (close == std::string_view::npos || !trimmed(line.substr(close + 1, end - close - 1)).empty()) {
          refuse("{}: line {}, column {}: a quoted cell must end with its quote, before the next separator",
                 where_, number_, columns_ + 1);
        }
        cell = trimmed(line.substr(first + 1, close - first - 1));
      } else {
        cell = trimmed(line.substr(0, end));
      }
      ++columns_;
      if (into.cells_.size() < most) into.cells_.push_back(cell);
      is_last = end == std::string_view::npos;
      line.remove_prefix(is_last ? line.size() : end + 1);
    }
  }

  void require_sound_names() const {
    const auto unnamed = std::ranges::find_if(names_, is_unnamed);
    if (unnamed != names_.end()) {
      refuse(
          "{}: columns must have names, and column {} has no name; name it in the first line, or leave it "
          "away if "
          "it numbers the rows (pandas: index=False, R: row.names=FALSE)",
          where_, unnamed - names_.begin() + 1);
    }
    std::vector<std::string_view> sorted(names_.begin(), names_.end());
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end()) {
      refuse("{}: columns must have different names, got {} twice", where_, *twice);
    }
  }

  /// Throws refusal for a table of more cells than are read.
  void require_few_cells(std::size_t lines, std::size_t columns) const {
    if (lines * columns <= most_cells) return;
    refuse(
        "{}: a table must have at most 2^22 = {} cells, got {} in a line and {} lines or more; take fewer "
        "lines",
        where_, most_cells, columns, lines);
  }

  std::string where_;
  std::string text_;
  std::string_view left_;
  std::size_t number_ = 0;   // of the line that was read last
  std::size_t columns_ = 0;  // of that line
  std::vector<std::string> names_;
};

std::string csv_row::place(std::size_t column) const {
  return fmt::format("{}: line {}, {}", where_, line_, names_[column]);
}

double csv_row::number(std::size_t column) {
  std::string_view cell = text(column);
  std::string with_point;
  const auto sign = cell.find_first_of(",.");
  if (sign != std::string_view::npos && separator_ != ',') {
    std::size_t& mine = cell[sign] == ',' ? line_of_comma_ : line_of_point_;
    if (mine == 0) mine = line_;
    if (line_of_comma_ != 0 && line_of_point_ != 0) {
      refuse("{} must have the decimal sign {} as line {} has, got '{}'", place(column),
             cell[sign] == ',' ? "'.'" : "','", std::min(line_of_comma_, line_of_point_), cell);
    }
    if (cell[sign] == ',') {
      with_point = cell;
      with_point[sign] = '.';
    }
  }
  const auto number = number_from(with_point.empty() ? cell : with_point);
  return number ? *number : number_of<double>(place(column), cell);
}

void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(csv_row&)>& row) {
  note_input(file);
  csv_reader(option, file).read(header, row);
}

}  // namespace nysalt::program
