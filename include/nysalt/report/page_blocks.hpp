// SPDX-License-Identifier: BSL-1.0
// What a page is made of, in its order.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "nysalt/report/table.hpp"

namespace nysalt {

struct heading_block {
  int level;  // 2 or 3: the title is 1
  std::string text;
};
struct text_block {
  std::string text;
};
struct list_block {
  std::vector<std::string> items;
};
struct table_block {
  table its;
};
struct code_block {
  std::string text;
};
struct picture_block {
  std::string name;  // of the figure, and of its files
  std::string caption;
};

using page_block =
    std::variant<heading_block, text_block, list_block, table_block, code_block, picture_block>;

}  // namespace nysalt
