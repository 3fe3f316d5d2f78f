// SPDX-License-Identifier: BSL-1.0
// Pictures by gnuplot: a script and its data, which stay beside what they drew.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figure.hpp"
#include "write_file.hpp"

namespace nysalt {

namespace detail {

/// The name is part of a command line and of the script, without quotes, so it may hold nothing that they
/// read.
void require_plain(const std::string& name);

}  // namespace detail

/// Writes NAME.dat and NAME.gp into the folder, and has gnuplot draw NAME.KIND of each kind, whole or
/// not at all. False if gnuplot is not there or fails; then data and script are there to draw later, and
/// no older picture stays beside them. Throws std::invalid_argument if the figure's name has other characters
/// than letters, digits, _ and -, std::runtime_error if a file cannot be written.
bool draw(const figure& f, const std::filesystem::path& folder,
          const std::vector<std::string>& kinds = {"svg", "png"});

}  // namespace nysalt
