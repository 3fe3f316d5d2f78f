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

namespace nysalt {

table::table(std::vector<std::string> columns, std::size_t left)
    : columns_(std::move(columns)), left_(left) {}

void table::add(std::vector<std::string> cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument(fmt::format(
        "table: a row must have a cell for each of {} columns, got {} cells", columns_.size(), cells.size()));
  }
  rows_.push_back(std::move(cells));
}

std::string table::text() const { return lay_out("", "  ", "", '-'); }

std::string table::markdown() const {
  table safe(*this);
  for (auto& cell : safe.columns_) cell = markdown_escaped(cell);
  for (auto& row : safe.rows_) {
    for (auto& cell : row) cell = markdown_escaped(cell);
  }
  return safe.lay_out("| ", " | ", " |", '-');
}

std::string table::html() const {
  std::string result = "<table>\n<thead>\n";
  const auto line = [&](const std::vector<std::string>& cells, const char* tag) {
    result += "<tr>";
    for (std::size_t j = 0; j < cells.size(); ++j) {
      constexpr std::size_t on_a_line = 30;  // bytes: what is longer is a list
      const char* kind = j < left_ ? "" : cells[j].size() > on_a_line ? " class=\"n long\"" : " class=\"n\"";
      result += fmt::format("<{0}{1}>{2}</{0}>", tag, kind, html_escaped(cells[j]));
    }
    result += "</tr>\n";
  };
  line(columns_, "th");
  result += "</thead>\n<tbody>\n";
  for (const auto& row : rows_) line(row, "td");
  return result + "</tbody>\n</table>\n";
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

namespace {
/// Whether the whole text is a number, "inf" or "nan", which may have a sign.
bool is_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double ignored = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  return end == text.data() + text.size() && error != std::errc::invalid_argument;
}
}  // namespace

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
    widths.push_back(columns_[j].size());
    for (const auto& row : rows_) widths[j] = std::max(widths[j], row[j].size());
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
