// SPDX-License-Identifier: BSL-1.0
// Tables of numbers that users bring.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace nysalt::program {

/// Reads a CSV file whose first line names its columns: header(names), then row(number of the line, cells)
/// for each further line that is not empty. Throws refusal, in the name of the option, if the file cannot be
/// read or a line has another number of columns than the first.
void read_csv(const std::string& option, const std::string& file,
              const std::function<void(const std::vector<std::string>&)>& header,
              const std::function<void(std::size_t, const std::vector<std::string>&)>& row);

}  // namespace nysalt::program
