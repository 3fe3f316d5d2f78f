// SPDX-License-Identifier: BSL-1.0
// The files of share/exports, in a source that CMake writes.
#pragma once

#include <span>
#include <string_view>

namespace nysalt::detail {

/// A file of share/exports.
struct bundled_template {
  std::string_view file;  ///< name without the folder: openmm.in
  std::string_view text;
};
std::span<const bundled_template> bundled_templates();

}  // namespace nysalt::detail
