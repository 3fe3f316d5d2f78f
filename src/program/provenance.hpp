// SPDX-License-Identifier: BSL-1.0
// With what a result was made: from names, scheme files and other results.
#pragma once

#include <string>
#include <vector>

#include "citations.hpp"

namespace nysalt::program {

/// Adds a method as it is typed to the first of the set-ups; the scheme of a file, which has a system of its
/// own, is one more. Throws refusal for what names nothing.
void add_method(const std::string& typed, std::vector<cited_setup>& to);

/// Adds what a file was made with: a scheme, a table, another result, or the folder of a report. Throws
/// refusal, naming the file, for what is unreadable or does not say how it was made.
void add_file(const std::string& file, std::vector<cited_setup>& to);

}  // namespace nysalt::program
