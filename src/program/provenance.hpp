// SPDX-License-Identifier: BSL-1.0
// With what a result was made: from names, scheme files and manifests.
#pragma once

#include <string>
#include <vector>

#include "citations.hpp"

namespace nysalt::program {

/// Adds a method as it is typed to the first of the set-ups; the scheme of a file, which has a system of its
/// own, is one more. Throws refusal for what names nothing.
void add_method(const std::string& typed, std::vector<cited_setup>& to);

/// Adds what a file was made with: a scheme or a table, a manifest, what has a manifest beside it, or the
/// folder of a report. Throws refusal, naming the file, for what is unreadable or has no provenance.
void add_file(const std::string& file, std::vector<cited_setup>& to);

}  // namespace nysalt::program
