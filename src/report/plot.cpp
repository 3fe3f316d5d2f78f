// SPDX-License-Identifier: BSL-1.0
#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "comparison/child_process.hpp"
#include "plot_script.hpp"

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

/// gnuplot also ends well where the output is not whole.
bool is_whole_picture(const std::string& text, const std::string& kind) {
  const std::string_view end = kind == "png" ? std::string_view("IEND\xae\x42\x60\x82", 8) : "</svg>";
  return text.find(end, text.size() - std::min<std::size_t>(text.size(), 64)) != std::string::npos;
}

/// A picture of older data must not stay beside new ones.
void remove_picture(const std::filesystem::path& picture) {
  std::error_code failure;
  if (std::filesystem::is_regular_file(picture, failure)) std::filesystem::remove(picture, failure);
}

}  // namespace

bool draw(const figure& f, const std::filesystem::path& folder, const std::vector<std::string>& kinds) {
  detail::require_plain(f.name);
  bool drawn = true;
  write_file(folder / (f.name + ".dat"), detail::plot_data(f));
  write_file(folder / (f.name + ".gp"), detail::plot_script(f));
  for (const std::string& kind : kinds) {
    const std::filesystem::path picture = folder / (f.name + "." + kind);
    const program::child_result made =
        program::run_child({"gnuplot", "-d", "-e", fmt::format("kind='{}'", kind), "./" + f.name + ".gp"},
                           folder, program::error_output::dropped);
    if (!made.succeeded() || !is_whole_picture(made.output, kind)) {
      remove_picture(picture);
      drawn = false;
      continue;
    }
    try {
      write_file(picture, made.output);
    } catch (...) {
      remove_picture(picture);
      throw;
    }
  }
  return drawn;
}

}  // namespace nysalt
