// SPDX-License-Identifier: BSL-1.0
// The little markup that the sentences of a report have: `` `code` ``, `**bold**` and `[text](link)`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nysalt {

/// Words of one style.
struct styled_words {
  /// The style of words.
  enum class kind { plain, code, bold, link };
  kind is = kind::plain;  ///< their style
  std::string text;       ///< the words, without marks
  std::string address{};  ///< of a link
};

/// The runs of words of a sentence. A mark that nothing closes means itself; marks do not nest.
std::vector<styled_words> plain_words(std::string_view text);

}  // namespace nysalt
