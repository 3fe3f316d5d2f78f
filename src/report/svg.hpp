// SPDX-License-Identifier: BSL-1.0
// Pictures of gnuplot as elements of a page.
#pragma once

#include <filesystem>
#include <string>

#include "figure.hpp"

namespace nysalt {

/// A picture that gnuplot drew of a figure, ready for a page with others: its ids, which gnuplot repeats in
/// every picture, begin with the figure's name, and a point says its values in a <title>, which browsers
/// show. Gone are titles of plots, for which they would be taken, and groups of nothing, a third of what
/// gnuplot writes.
std::string finished_svg(const std::string& drawn, const figure& f);

/// The svg element of a picture's file, without the prolog, which only a file may have. Empty if there is
/// none, or none that is whole.
std::string svg_element(const std::filesystem::path& file);

}  // namespace nysalt
