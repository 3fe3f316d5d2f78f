// SPDX-License-Identifier: BSL-1.0
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include "plot_script.hpp"
#include "quoted.hpp"

namespace nysalt {

void detail::require_plain(const std::string& name) {
  const auto plain = [](char c) {  // in any locale
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), plain)) {
    throw std::invalid_argument(
        fmt::format("draw: the name of a figure is of letters, digits, _ and -, not \"{}\"", name));
  }
}

bool draw(const figure& f, const std::filesystem::path& folder) {
  detail::require_plain(f.name);
  bool drawn = true;
  write_file(folder / (f.name + ".dat"), detail::plot_data(f));
  write_file(folder / (f.name + ".gp"), detail::plot_script(f));
  for (const std::string kind : {"svg", "png"}) {
    const std::string picture = f.name + "." + kind;
    const std::string command =
        fmt::format("cd {} && gnuplot -e \"kind='{}'; target='{}.tmp'\" ./{}.gp 2>/dev/null",
                    detail::quoted_for_shell(folder.string()), kind, picture, f.name);
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
