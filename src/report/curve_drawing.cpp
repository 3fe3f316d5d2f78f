// SPDX-License-Identifier: BSL-1.0
#include "curve_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "quoted.hpp"

namespace nysalt::detail {

namespace {

bool has_points(const panel& plot) { return plot.log_log || plot.points; }

}  // namespace

bool has_hollow(const curve& one) {
  return std::find(one.hollow.begin(), one.hollow.end(), true) != one.hollow.end();
}

curve_style style_of(const panel& plot, std::size_t j) {
  // Okabe and Ito's colours but yellow, which white paper hides. 7 and 6 have no common divisor: the first 42
  // curves differ.
  static constexpr const char* colours[] = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                            "#56B4E9", "#E69F00", "#000000"};
  static constexpr int shapes[] = {7, 5, 9, 13, 11, 15};
  static constexpr const char* dashes[] = {"1", "(12,4)", "(4,3)", "(12,3,2,3)", "(2,3)"};
  const curve& one = plot.curves[j];
  const auto plain = std::count_if(plot.curves.begin(), plot.curves.begin() + static_cast<std::ptrdiff_t>(j),
                                   [](const curve& c) { return !c.emphasised && !c.front; });
  const char* dash = dashes[static_cast<std::size_t>(plain) % std::size(dashes)];
  if (one.emphasised) dash = "1";
  if (one.dashed) dash = "(8,5)";
  const double width = one.emphasised ? 2.8 : 1.2;
  return {colours[j % std::size(colours)], shapes[j % std::size(shapes)], dash, width,
          one.emphasised ? 1.1 : 0.8};
}

std::vector<std::string> drawing_of(const panel& plot, std::size_t j, const std::string& data) {
  const curve& one = plot.curves[j];
  if (one.front) return {data + " using 1:2 with steps lc 'black' lw 1.6 dt (3,3) notitle"};
  const curve_style seen = style_of(plot, j);
  std::vector<std::string> result;
  if (!one.points_only) {
    result.push_back(fmt::format("{} using 1:2 with lines lc '{}' lw {} dt {} notitle", data, seen.colour,
                                 seen.width, seen.dash));
  }
  if (!has_points(plot) && !one.points_only) return result;
  const auto points = [&](const char* y, int type) {
    result.push_back(fmt::format("{} using 1:{}:3 with yerrorbars lc '{}' lw 1 pt {} ps {} notitle", data, y,
                                 seen.colour, type, seen.size));
  };
  points(!has_hollow(one) ? "2" : "($4 == 0 ? $2 : NaN)", seen.point);
  if (has_hollow(one)) points("($4 == 1 ? $2 : NaN)", seen.point - 1);
  return result;
}

std::string key_entry(const panel& plot, std::size_t j) {
  const curve& one = plot.curves[j];
  if (one.front)
    return fmt::format("keyentry with lines lc 'black' lw 1.6 dt (3,3) title {}", quoted(one.label));
  const curve_style seen = style_of(plot, j);
  const bool points = has_points(plot) || one.points_only;
  const char* style = one.points_only ? "points" : points ? "linespoints" : "lines";
  std::string result = fmt::format("keyentry with {} lc '{}'", style, seen.colour);
  if (!one.points_only) result += fmt::format(" lw {} dt {}", seen.width, seen.dash);
  if (points) result += fmt::format(" pt {} ps {}", seen.point, seen.size);
  return result + " title " + quoted(one.label);
}

std::string style_of_intervals(std::size_t label) {
  if (label == 0) return "fc '#dcebdc' fs solid 1 noborder";
  return "fc '#56B4E9' fs transparent solid 0.5 border lc '#0072B2'";
}

std::vector<std::string> labels_of_intervals(const panel& plot) {
  std::vector<std::string> labels;
  for (const auto& one : plot.intervals) {
    if (std::find(labels.begin(), labels.end(), one.label) == labels.end()) labels.push_back(one.label);
  }
  return labels;
}

}  // namespace nysalt::detail
