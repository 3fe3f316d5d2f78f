// SPDX-License-Identifier: BSL-1.0
#include "svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "escaped.hpp"

namespace nysalt {

namespace {

/// "verlet: step 0.1, error 3.2e-04 ± 1e-05", of point i of curve j, which are counted over all panels.
std::string value_of(const figure& f, std::size_t j, std::size_t i) {
  for (const auto& panel : f.panels) {
    if (j >= panel.curves.size()) {
      j -= panel.curves.size();
      continue;
    }
    const curve& one = panel.curves[j];
    if (i >= one.x.size() || i >= one.y.size()) break;
    const auto named = [](const std::string& name) { return name.empty() ? name : name + " "; };
    std::string text = fmt::format("{}: {}{:.4g}, {}{:.4g}", one.label, named(panel.x_label), one.x[i],
                                   named(panel.y_label), one.y[i]);
    const bool has_error = i < one.error.size() && std::isfinite(one.error[i]) && one.error[i] > 0.0;
    return has_error ? text + fmt::format(" ± {:.1g}", one.error[i]) : text;
  }
  return {};
}

void insert_after(std::string& text, std::string_view mark, const std::string& inserted) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at)) {
    at += mark.size();
    text.insert(at, inserted);
  }
}

/// The number of the curve and of the point in it, where a tag shows such.
std::optional<std::pair<std::size_t, std::size_t>> point_of(const std::string& tag) {
  constexpr std::string_view shows = "showHypertext(evt,'";
  const std::size_t at = tag.find(shows);
  if (at == std::string::npos) return std::nullopt;
  const char* from = tag.c_str() + at + shows.size();
  char* end = nullptr;
  const std::size_t j = std::strtoul(from, &end, 10);
  if (end == from || *end != '.') return std::nullopt;
  return std::pair(j, std::size_t{std::strtoul(end + 1, nullptr, 10)});
}

/// With own ids, and the values of a point.
std::string finished_tag(std::string tag, const figure& f) {
  if (const auto point = point_of(tag)) {
    return fmt::format("<g class=\"point\"><title>{}</title>",
                       html_escaped(value_of(f, point->first, point->second)));
  }
  constexpr std::string_view of_panel = " id=\"gnuplot_plot_";  // which panels repeat
  if (const std::size_t at = tag.find(of_panel); at != std::string::npos) {
    const std::size_t end = tag.find('"', at + of_panel.size());
    if (end != std::string::npos) tag.erase(at, end + 1 - at);
  }
  for (const char* mark : {" id='", " id=\"", "href='#", "href=\"#", "url(#", "url('#", "url(\"#"}) {
    insert_after(tag, mark, f.name + "-");
  }
  return tag;
}

/// Tags, and what is between them, in order. No regular expression: gnuplot writes the points of a curve as
/// one tag of tens of thousands of characters, and libstdc++ matches each of these one call deeper.
std::vector<std::string_view> pieces_of(std::string_view text) {
  std::vector<std::string_view> result;
  while (!text.empty()) {
    const bool is_tag = text.front() == '<';
    const std::size_t end = text.find(is_tag ? '>' : '<');
    const std::size_t length = end == std::string_view::npos ? text.size() : is_tag ? end + 1 : end;
    result.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return result;
}

bool is_blank(std::string_view piece) { return piece.find_first_not_of(" \t\r\n") == std::string_view::npos; }

/// Without titles and descriptions, with the space behind them.
std::vector<std::string_view> without_titles(const std::vector<std::string_view>& pieces) {
  std::vector<std::string_view> result;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string_view end = pieces[i] == "<title>" ? "</title>" : pieces[i] == "<desc>" ? "</desc>" : "";
    const std::size_t last = i + 1 < pieces.size() && pieces[i + 1] == end ? i + 1 : i + 2;
    if (end.empty() || last >= pieces.size() || pieces[last] != end) {
      result.push_back(pieces[i]);
      continue;
    }
    i = last + 1 < pieces.size() && is_blank(pieces[last + 1]) ? last + 1 : last;
  }
  return result;
}

/// Without groups that hold nothing, or only such groups.
std::vector<std::string_view> without_empty_groups(const std::vector<std::string_view>& pieces) {
  std::vector<std::string_view> result;
  for (const std::string_view piece : pieces) {
    if (piece != "</g>") {
      result.push_back(piece);
      continue;
    }
    std::size_t kept = result.size();
    while (kept > 0 && is_blank(result[kept - 1])) --kept;
    if (kept > 0 && result[kept - 1].starts_with("<g ")) {
      result.resize(kept - 1);
    } else {
      result.push_back(piece);
    }
  }
  return result;
}

}  // namespace

std::string finished_svg(const std::string& drawn, const figure& f) {
  std::string result;
  for (const std::string_view piece : without_empty_groups(without_titles(pieces_of(drawn)))) {
    if (piece.starts_with('<')) {
      result += finished_tag(std::string(piece), f);
    } else {
      result += piece;
    }
  }
  return result;
}

std::string svg_element(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t from = text.find("<svg");
  const std::string last = "</svg>";
  const std::size_t end = text.rfind(last);
  const bool is_whole = from != std::string::npos && end != std::string::npos && from < end;
  return is_whole ? text.substr(from, end + last.size() - from) : "";
}

}  // namespace nysalt
