// SPDX-License-Identifier: BSL-1.0
// Tables of numbers that users bring.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nysalt::program {

/// Line of a table, valid while it is handed on.
class csv_row {
 public:
  csv_row(std::string where, const std::vector<std::string>& names, char separator)
      : where_(std::move(where)), names_(names), separator_(separator) {}

  std::size_t line() const { return line_; }  ///< counted from 1
  std::size_t size() const { return cells_.size(); }
  /// Without blanks around it and quotes.
  std::string_view text(std::size_t column) const { return cells_[column]; }
  /// Throws refusal, with file, line and column, if the cell is no finite number. Where commas do not
  /// separate columns, one may be the decimal sign, in all of the table.
  double number(std::size_t column);
  /// "--data FILE: line 3, NAME"
  std::string place(std::size_t column) const;

 private:
  friend class csv_reader;

  std::string where_;  // option and file
  const std::vector<std::string>& names_;
  char separator_;
  std::size_t line_ = 0;
  std::vector<std::string_view> cells_;
  std::size_t line_of_comma_ = 0;  // the first with a decimal comma, or with a decimal point
  std::size_t line_of_point_ = 0;
};

/// Reads a table of at most 64 megabytes and 2^22 cells, in UTF-8: columns separated by commas, semicolons or
/// tabs, whichever the first line has most of; names and cells may be in quotes and have blanks around them.
/// Calls header(names), then row() for each further line that is not empty. Throws refusal, in the name of
/// the option, if the file cannot be read, is larger, has a column without a name, two of one name, or a line
/// with another number of columns than the first.
void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(csv_row&)>& row);

}  // namespace nysalt::program
