// SPDX-License-Identifier: BSL-1.0
// Blocks of a page, in their order.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "table.hpp"

namespace nysalt {

/// Begins a section, or a part of one.
struct heading_block {
  int level;         ///< 2 or 3: the title is 1
  std::string text;  ///< a sentence
};
/// A paragraph.
struct text_block {
  std::string text;         ///< sentences
  bool is_verdict = false;  ///< the first of these stays in view
};
/// Items with a dot before each.
struct list_block {
  std::vector<std::string> items;  ///< sentences
};
/// A table.
struct table_block {
  table rows;  ///< whose cells have no markup
};
/// A command or an output.
struct code_block {
  std::string text;  ///< shown unchanged
};
/// A picture and what is said below it.
struct picture_block {
  std::string name;     ///< of the figure, and of its files
  std::string caption;  ///< a sentence
};

/// A block of a page: one of those above.
using page_block =
    std::variant<heading_block, text_block, list_block, table_block, code_block, picture_block>;

}  // namespace nysalt
