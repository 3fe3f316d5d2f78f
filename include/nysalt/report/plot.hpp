// SPDX-License-Identifier: BSL-1.0
// Pictures by gnuplot: a script and its data, which stay beside what they drew.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "nysalt/report/figure.hpp"
#include "nysalt/report/plot_script.hpp"
#include "nysalt/report/quoted.hpp"
#include "nysalt/report/write_file.hpp"

namespace nysalt {

namespace detail {

/// The name stands in a command line and in the script as it is, so it may hold nothing that they read.
inline void require_plain(const std::string& name) {
  const auto plain = [](char c) {  // in any locale
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), plain)) {
    throw std::invalid_argument(
        fmt::format("draw: the name of a figure is of letters, digits, _ and -, not \"{}\"", name));
  }
}

}  // namespace detail

/// Writes NAME.dat and NAME.gp into the folder, and has gnuplot draw NAME.svg and NAME.png, each whole or
/// not at all. False if gnuplot is not there or fails; then data and script are there to draw later, and
/// no older picture stays beside them. Throws std::invalid_argument if the figure's name has other characters
/// than letters, digits, _ and -, std::runtime_error if the folder cannot be written.
inline bool draw(const figure& f, const std::filesystem::path& folder) {
  detail::require_plain(f.name);
  bool drawn = true;
  write_file(folder / (f.name + ".dat"), detail::plot_data(f));
  write_file(folder / (f.name + ".gp"), detail::plot_script(f));
  for (const std::string kind : {"svg", "png"}) {
    const std::string picture = f.name + "." + kind;
    const std::string command =
        fmt::format("cd {} && gnuplot -e \"kind='{}'; target='{}.tmp'\" ./{}.gp 2>/dev/null",
                    detail::quoted(folder.string(), R"('\'')"), kind, picture, f.name);
    if (std::system(command.c_str()) == 0) {
      std::filesystem::rename(folder / (picture + ".tmp"), folder / picture);
      continue;
    }
    drawn = false;
    std::error_code ignored;
    std::filesystem::remove(folder / (picture + ".tmp"), ignored);
    std::filesystem::remove(folder / picture, ignored);  // that of older data
  }
  return drawn;
}

}  // namespace nysalt
