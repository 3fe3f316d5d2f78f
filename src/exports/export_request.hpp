// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <optional>
#include <string>

namespace nysalt::program {

/// How a method is exported.
struct export_request {
  std::string name;            ///< identifier in the file; empty: that of the family or method
  std::optional<double> step;  ///< of a scheme over several steps
  bool displaced = false;      ///< gradient kicks become displaced kicks
};

}  // namespace nysalt::program
