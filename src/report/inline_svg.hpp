// SPDX-License-Identifier: BSL-1.0
// A picture's file as an element of a page that has others.
#pragma once

#include <filesystem>
#include <string>

namespace nysalt {

/// Without the prolog, which only a file may have, named for those who cannot see it, and with ids of its
/// own: gnuplot gives the same ones to each picture, and the first in a page would serve all. `name` is that
/// prefix, `label` is escaped already. Empty if there is no such file, or no whole svg element in it.
std::string inline_svg(const std::filesystem::path& file, const std::string& name, const std::string& label);

}  // namespace nysalt
