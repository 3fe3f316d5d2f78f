// SPDX-License-Identifier: BSL-1.0
#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "escaped.hpp"
#include "terminal.hpp"

namespace nysalt {

namespace {

/// With "..." for the middle.
std::string shortened(const std::string& word, std::size_t columns) {
  const std::size_t kept = columns - 3;
  const auto part = [&](std::size_t from, std::size_t count) {
    std::size_t at = 0;
    const auto next = [&] {
      do ++at;
      while (at < word.size() && (static_cast<unsigned char>(word[at]) & 0xc0U) == 0x80U);
    };
    while (from-- > 0) next();
    const std::size_t begin = at;
    while (count-- > 0) next();
    return word.substr(begin, at - begin);
  };
  return part(0, kept / 2) + "..." + part(columns_of(word) - (kept - kept / 2), kept - kept / 2);
}

/// Whether the whole text is a number, "inf" or "nan", which may have a sign.
bool is_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double ignored = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  return end == text.data() + text.size() && error != std::errc::invalid_argument;
}
}  // namespace

table::table(std::vector<std::string> columns, std::size_t left)
    : columns_(std::move(columns)), left_(left) {}

void table::add(std::vector<std::string> cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument(fmt::format(
        "table: a row must have a cell for each of {} columns, got {} cells", columns_.size(), cells.size()));
  }
  rows_.push_back(std::move(cells));
}

std::string table::text(std::size_t width) const {
  table narrow(*this);
  for (;;) {
    std::string result = narrow.lay_out("", "  ", "", '-');
    const std::size_t taken = columns_of(std::string_view(result).substr(0, result.find('\n')));
    std::string* longest = nullptr;
    for (auto& row : narrow.rows_) {
      for (std::size_t j = 0; j < left_; ++j) {
        if (longest == nullptr || columns_of(row[j]) > columns_of(*longest)) longest = &row[j];
      }
    }
    constexpr std::size_t least = 12;  // columns, of which a name is still one
    if (taken <= width || longest == nullptr || columns_of(*longest) <= least) return result;
    *longest = shortened(
        *longest, std::max(least, columns_of(*longest) - std::min(taken - width, columns_of(*longest))));
  }
}

std::string table::markdown() const {
  table safe(*this);
  for (auto& cell : safe.columns_) cell = markdown_escaped(cell);
  for (auto& row : safe.rows_) {
    for (auto& cell : row) cell = markdown_escaped(cell);
  }
  return safe.lay_out("| ", " | ", " |", '-');
}

std::string table::csv() const {
  std::string result;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t j = 0; j < cells.size(); ++j) {
      if (j > 0) result += ',';
      result += quoted(cells[j]);
    }
    result += '\n';
  };
  line(columns_);
  for (const auto& row : rows_) line(row);
  return result;
}

std::string table::quoted(const std::string& cell) {
  // A spreadsheet takes a text that begins so for a formula, and some do behind blanks; numbers begin with +
  // or
  // - too.
  const std::size_t first = cell.find_first_not_of(" \t\r\n");
  const bool is_formula = first != std::string::npos && first + 1 < cell.size() &&
                          std::string_view("=+-@").find(cell[first]) != std::string_view::npos &&
                          !is_number(cell);
  if (is_formula) return quoted("'" + cell);
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string result = "\"";
  for (const char c : cell) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

std::string table::lay_out(const char* left, const char* between, const char* right, char rule) const {
  std::vector<std::size_t> widths;
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    widths.push_back(columns_of(columns_[j]));
    for (const auto& row : rows_) widths[j] = std::max(widths[j], columns_of(row[j]));
  }
  std::string result;
  const auto line = [&](const std::vector<std::string>& cells) {
    result += left;
    for (std::size_t j = 0; j < cells.size(); ++j) {
      if (j > 0) result += between;
      result +=
          j < left_ ? fmt::format("{:<{}}", cells[j], widths[j]) : fmt::format("{:>{}}", cells[j], widths[j]);
    }
    result += std::string(right) + '\n';
  };
  std::vector<std::string> rules;
  for (const std::size_t width : widths) rules.emplace_back(width, rule);
  line(columns_);
  line(rules);
  for (const auto& row : rows_) line(row);
  return result;
}

}  // namespace nysalt
