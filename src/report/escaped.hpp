// SPDX-License-Identifier: BSL-1.0
// Text that is shown as it is, with any characters, in HTML and in Markdown.
#pragma once

#include <string>
#include <string_view>

namespace nysalt {

/// In the text of an element, or in an attribute between quotes.
/// Outside code: a backslash before what GitHub's Markdown would read; a line break becomes a blank. An
/// underscore inside a word stays bare, as Markdown reads it so and names of methods have them.
std::string markdown_escaped(std::string_view text);

}  // namespace nysalt
