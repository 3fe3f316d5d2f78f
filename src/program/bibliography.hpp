// SPDX-License-Identifier: BSL-1.0
// The works of docs/bibliography.bib, by key; they are part of the program.
#pragma once

#include <string>
#include <string_view>

namespace nysalt::program {

/// The entry as BibTeX, without an end of line. Throws logic_error for a key that is not there.
std::string bibtex_of(std::string_view key);

}  // namespace nysalt::program
