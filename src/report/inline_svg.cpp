// SPDX-License-Identifier: BSL-1.0
#include "inline_svg.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace nysalt {

namespace {

/// Whether url(#NAME) or href="#NAME" is somewhere in it.
bool is_used(std::string_view svg, const std::string& id) {
  const std::string use = "#" + id;
  for (std::size_t at = svg.find(use); at != std::string_view::npos; at = svg.find(use, at + 1)) {
    const std::size_t behind = at + use.size();
    if (behind < svg.size() && std::string_view("'\")").find(svg[behind]) != std::string_view::npos)
      return true;
  }
  return false;
}

/// `prefix` before the name that the tag gives, if something uses it (else none is given), and before those
/// that it uses.
std::string with_own_ids(std::string tag, std::string_view svg, const std::string& prefix) {
  const std::size_t id = std::min(tag.find(" id=\""), tag.find(" id='"));
  if (id != std::string::npos) {
    const std::size_t from = id + std::string_view(" id='").size();
    const std::size_t end = tag.find(tag[from - 1], from);
    const bool used = end != std::string::npos && is_used(svg, tag.substr(from, end - from));
    if (used)
      tag.insert(from, prefix);
    else if (end != std::string::npos)
      tag.erase(id, end + 1 - id);
  }
  for (const std::string_view before : {"url(#", "url('#", "url(\"#", "href=\"#", "href='#"}) {
    for (std::size_t at = tag.find(before); at != std::string::npos; at = tag.find(before, at)) {
      at += before.size();
      tag.insert(at, prefix);
    }
  }
  return tag;
}

/// Tags, and the text between them unless it is blank.
std::vector<std::string_view> svg_pieces(std::string_view svg) {
  std::vector<std::string_view> result;
  for (std::size_t at = 0; at < svg.size();) {
    const bool is_tag = svg[at] == '<';
    const std::size_t found = svg.find(is_tag ? '>' : '<', at);
    const std::size_t next = found == std::string_view::npos ? svg.size() : found + (is_tag ? 1 : 0);
    const std::string_view piece = svg.substr(at, next - at);
    if (piece.find_first_not_of(" \t\r\n") != std::string_view::npos) result.push_back(piece);
    at = next;
  }
  return result;
}

/// Without titles, which would pop up under the mouse ("gnuplot_plot_1"), and without groups of nothing,
/// which are a third of what gnuplot writes.
std::vector<std::string_view> without_empty(const std::vector<std::string_view>& pieces) {
  std::vector<std::string_view> result;
  bool in_title = false;
  for (const auto piece : pieces) {
    if (piece.starts_with("<title") || piece.starts_with("<desc")) in_title = true;
    if (piece == "</g>" && !result.empty() && result.back().starts_with("<g") &&
        !result.back().ends_with("/>")) {
      result.pop_back();
    } else if (!in_title) {
      result.push_back(piece);
    }
    if (piece == "</title>" || piece == "</desc>") in_title = false;
  }
  return result;
}

}  // namespace

std::string inline_svg(const std::filesystem::path& file, const std::string& name, const std::string& label) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t from = text.find("<svg");
  const std::size_t end = text.rfind("</svg>");
  if (from == std::string::npos || end == std::string::npos || end < from) return "";
  const auto svg = std::string_view(text).substr(from + 4, end - from - 4);
  std::string result = "<svg role=\"img\" aria-label=\"" + label + "\"";
  const std::size_t head = svg.find('>');
  result += svg.substr(0, head);
  for (const auto piece : without_empty(svg_pieces(svg.substr(head)))) {
    result += piece.starts_with('<') ? with_own_ids(std::string(piece), svg, name + "-") : std::string(piece);
    if (piece.starts_with("</")) result += '\n';
  }
  return result + "</svg>";
}

}  // namespace nysalt
