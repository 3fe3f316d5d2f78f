// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <stdexcept>

namespace nysalt::detail {

/// A failure to write that is not due to bad input: the disk is full, or a device failed.
class write_failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Another process writes the file.
class file_in_use : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nysalt::detail
