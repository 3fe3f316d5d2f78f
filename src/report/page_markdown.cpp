// SPDX-License-Identifier: BSL-1.0
#include "page_markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "escaped.hpp"
#include "plain_words.hpp"

namespace nysalt {

namespace {

/// The longest run of backquotes in it: a fence of code has more.
std::size_t longest_backquotes(std::string_view text) {
  std::size_t longest = 0;
  std::size_t run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

std::string markdown_sentence(std::string_view text) {
  std::string result;
  for (const styled_words& words : plain_words(text)) {
    switch (words.is) {
      case styled_words::kind::plain:
        result += markdown_escaped(words.text);
        break;
      case styled_words::kind::code:
        result += "`" + words.text + "`";
        break;
      case styled_words::kind::bold:
        result += "**" + markdown_escaped(words.text) + "**";
        break;
      case styled_words::kind::link:
        result += fmt::format("[{}]({})", markdown_escaped(words.text), words.address);
    }
  }
  return result;
}

struct markdown_of_block {
  const std::string& pictures;

  std::string operator()(const heading_block& heading) const {
    return std::string(static_cast<std::size_t>(heading.level), '#') + " " + markdown_sentence(heading.text) +
           "\n";
  }
  std::string operator()(const text_block& paragraph) const {
    return markdown_sentence(paragraph.text) + "\n";
  }
  std::string operator()(const list_block& list) const {
    std::string result;
    for (const auto& item : list.items) result += fmt::format("- {}\n", markdown_sentence(item));
    return result;
  }
  std::string operator()(const table_block& block) const { return block.rows.markdown(); }
  std::string operator()(const code_block& code) const {
    const std::string fence(std::max<std::size_t>(3, longest_backquotes(code.text) + 1), '`');
    return fmt::format("{0}\n{1}{2}{0}\n", fence, code.text, code.text.ends_with('\n') ? "" : "\n");
  }
  std::string operator()(const picture_block& picture) const {
    const std::string caption = markdown_sentence(picture.caption);
    const std::string folder = pictures.empty() || pictures.ends_with('/') ? pictures : pictures + "/";
    return fmt::format("![{0}]({1}{2}.svg)\n\n{0}\n", caption, folder, picture.name);
  }
};

}  // namespace

std::string page_markdown(const std::string& title, const std::vector<page_block>& blocks,
                          const std::string& pictures) {
  std::string result = fmt::format("# {}\n", markdown_sentence(title));
  for (const auto& block : blocks) {
    result += fmt::format("\n{}", std::visit(markdown_of_block{pictures}, block));
  }
  return result;
}

}  // namespace nysalt
