// SPDX-License-Identifier: BSL-1.0
#include <algorithm>

#include "program_run.hpp"

namespace nysalt::fuzz {

namespace {

bool is_one_line(const std::string& text) {
  const auto is_control = [](unsigned char c) { return c < ' '; };
  return text.starts_with("nysalt: ") && text.ends_with('\n') &&
         std::none_of(text.begin(), text.end() - 1, is_control);
}

}  // namespace

std::string broken_promise(const remains& left, const std::set<std::string>& files_before) {
  if (left.code != 0 && left.code != 2 && left.code != 3) return "an exit code that is not 0, 2 or 3";
  const auto is_half_written = [&](const std::string& name) {
    return name.find(".part") != std::string::npos && !files_before.contains(name);
  };
  if (std::any_of(left.files.begin(), left.files.end(), is_half_written)) return "a file is half written";
  if (left.code != 2) return "";
  if (!is_one_line(left.err)) return "a refusal is not one line of plain characters";
  if (!left.out.empty()) return "something is printed beside a refusal";
  if (left.files != files_before || !left.inputs_are_whole) return "a refusal leaves the folder changed";
  return "";
}

}  // namespace nysalt::fuzz
