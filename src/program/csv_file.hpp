// SPDX-License-Identifier: BSL-1.0
// Tables of numbers that users bring.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/number.hpp"

namespace nysalt::program {

/// Reads a CSV file of at most 64 megabytes and 2^22 cells whose first line names its columns: header(names),
/// then row(number of the line, cells) for each further line that is not empty. Throws refusal, in the name
/// of the option, if the file cannot be read, is larger, or a line has another number of columns than the
/// first.
void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(std::size_t, const std::vector<std::string_view>&)>& row);

/// The number in a cell. Throws refusal, with what place() says of the cell, if there is none.
double number_in_cell(std::string_view cell, const auto& place) {
  const auto number = number_from(cell);
  return number ? *number : number_of<double>(place(), cell);
}

}  // namespace nysalt::program
