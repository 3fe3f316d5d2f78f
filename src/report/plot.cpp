// SPDX-License-Identifier: BSL-1.0
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "nysalt/detail/unfinished_names.hpp"
#include "plot_script.hpp"
#include "quoted.hpp"
#include "svg.hpp"

namespace nysalt {

void detail::require_plain(const std::string& name) {
  const auto plain = [](char c) {  // in any locale
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), plain)) {
    throw std::invalid_argument(
        fmt::format("draw: the name of a figure must be letters, digits, _ and -, got '{}'", name));
  }
}

namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

/// gnuplot ends well where its disk was full.
bool is_whole_picture(const std::string& text, const std::string& kind) {
  const std::string_view end = kind == "png" ? std::string_view("IEND\xae\x42\x60\x82", 8) : "</svg>";
  return text.find(end, text.size() - std::min<std::size_t>(text.size(), 64)) != std::string::npos;
}

bool is_written(const std::filesystem::path& file, const std::string& text) {
  try {
    write_file(file, text);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace

bool draw(const figure& f, const std::filesystem::path& folder) {
  detail::require_plain(f.name);
  bool drawn = true;
  write_file(folder / (f.name + ".dat"), detail::plot_data(f));
  write_file(folder / (f.name + ".gp"), detail::plot_script(f));
  for (const std::string kind : {"svg", "png"}) {
    const std::string picture = f.name + "." + kind;
    const std::string command = fmt::format(
        "CDPATH= cd -- {} >/dev/null && gnuplot -e \"kind='{}'; target='{}.tmp'\" ./{}.gp 2>/dev/null",
        detail::quoted_for_shell(folder.string()), kind, picture, f.name);
    const std::filesystem::path made = folder / (picture + ".tmp");
    const detail::unfinished_name unfinished(made);
    std::error_code failure;
    const bool has_ended = std::system(command.c_str()) == 0;
    const std::string text = has_ended ? bytes_of(made) : std::string();
    std::filesystem::remove(made, failure);
    if (is_whole_picture(text, kind) &&
        is_written(folder / picture, kind == "svg" ? finished_svg(text, f) : text)) {
      continue;
    }
    drawn = false;
    if (std::filesystem::is_regular_file(folder / picture, failure))
      std::filesystem::remove(folder / picture, failure);  // that of older data
  }
  return drawn;
}

}  // namespace nysalt
