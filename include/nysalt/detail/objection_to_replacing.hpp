// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <filesystem>
#include <string>

namespace nysalt::detail {

/// Why a file that is written must not take the name, or the place of what a link of that name leads to: a
/// folder, a device, a FIFO or a socket is there, or a link that leads back to itself. Empty if a regular
/// file or nothing is there.
std::string objection_to_replacing(const std::filesystem::path& file);

}  // namespace nysalt::detail
