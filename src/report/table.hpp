// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace nysalt {

/// Rows of text under named columns, for people (text, Markdown) and for machines (CSV).
class table {
 public:
  /// The first `left` columns are set to the left, for words; the others to the right, for numbers.
  explicit table(std::vector<std::string> columns, std::size_t left = 1);

  /// Adds a row. Throws std::invalid_argument unless there is a cell for each column.
  void add(std::vector<std::string> cells);

  const std::vector<std::string>& columns() const { return columns_; }         ///< their names
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }  ///< as many cells in each
  std::size_t left() const { return left_; }                                   ///< number of columns of words
  bool empty() const { return rows_.empty(); }                                 ///< whether there is no row
  std::size_t size() const { return rows_.size(); }                            ///< number of rows

  /// Columns aligned by blanks, with a rule below their names. Where that is wider than `width`, the middle
  /// of the longest words on the left is left out.
  std::string text(std::size_t width = std::string::npos) const;
  /// GitHub's Markdown, aligned too; cells are escaped.
  std::string markdown() const;

  /// RFC 4180: cells with commas, quotes or line breaks are quoted.
  std::string csv() const;

 private:
  static std::string quoted(const std::string& cell);

  std::string lay_out(const char* left, const char* between, const char* right, char rule) const;

  std::vector<std::string> columns_;
  std::size_t left_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace nysalt
