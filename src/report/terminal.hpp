// SPDX-License-Identifier: BSL-1.0
// Results as text on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nysalt {

/// The number of columns that a text of UTF-8 takes.
std::size_t columns_of(std::string_view text);

/// The lines of a text, each broken at blanks where it is longer than that many columns: what follows is
/// indented by two more. A word that is longer stays whole. Ends with a line break unless empty.
std::string wrapped(std::string_view text, std::size_t width);

/// The same of a text whose names are between backquotes, without these.
std::string wrapped_plainly(std::string text, std::size_t width);

}  // namespace nysalt
