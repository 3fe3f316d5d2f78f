// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "page_blocks.hpp"

namespace nysalt {

/// See page::html().
std::string page_html(const std::string& title, const std::vector<page_block>& blocks,
                      const std::filesystem::path& pictures);

}  // namespace nysalt
