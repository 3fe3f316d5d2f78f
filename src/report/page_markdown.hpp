// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>
#include <vector>

#include "page_blocks.hpp"

namespace nysalt {

/// See page::markdown().
std::string page_markdown(const std::string& title, const std::vector<page_block>& blocks,
                          const std::string& pictures);

}  // namespace nysalt
