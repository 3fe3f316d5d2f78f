// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <stdexcept>

namespace nysalt::detail {

/// What could not be written though nothing was wrong with what was asked: the disk is full, or a device failed.
class write_failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace nysalt::detail
