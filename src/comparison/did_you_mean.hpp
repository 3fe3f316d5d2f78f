// SPDX-License-Identifier: BSL-1.0
// Suggestions for a mistyped name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nysalt::program {

/// The known name nearest to what was typed, ignoring case; empty if none is near. Near is
/// a name that begins with the text, of three letters at least; or one that a mistake (a letter missing, too
/// many, wrong, or two exchanged) in three letters turns it into.
std::string nearest_name(std::string_view typed, const std::vector<std::string>& known);

/// The end of a sentence on an unknown name: "did you mean fg4?"; if no name is near "it is one of a, b" of
/// a few names, and of more what is said `otherwise`.
std::string did_you_mean(std::string_view typed, const std::vector<std::string>& known,
                         std::string_view otherwise = "nysalt list shows all");

}  // namespace nysalt::program
