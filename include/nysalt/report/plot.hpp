// SPDX-License-Identifier: BSL-1.0
// Pictures by gnuplot: a script and its data, which stay beside what they drew.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/report/write_file.hpp"

namespace nysalt {

struct curve {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> error{};  // of y, drawn as bars if given
  bool emphasised = false;      // solid and thick; what is learned
  std::vector<bool> hollow{};   // points that are shown but do not count, as beyond a limit
  bool dashed = false;
  bool points_only = false;  // not joined
  bool front = false;        // a Pareto front, from cheap to dear: dotted black steps behind the others
};

/// A horizontal line to compare with: the null model, the floor of sampling.
struct level {
  std::string label;
  double y;
};

struct panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_log = false;  // with points; else plain lines
  std::vector<curve> curves;
  std::string y_range = "[*:*]";
  bool linear_y = false;  // where log_log would be, of what does not go to 0
  bool points = false;    // where axes are plain: points with bars as well as lines
  std::vector<level> levels{};
};

struct figure {
  std::string name;           // of the files: letters, digits, _ and -
  std::vector<panel> panels;  // side by side
  int width = 800;            // a key that stands beside a panel is added to it
  int height = 520;
};

namespace detail {

/// In single quotes, with what one inside is written as: '' for gnuplot, '\'' for the shell.
inline std::string quoted(const std::string& text, const char* inside = "''") {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string(inside) : std::string(1, c);
  return result + "'";
}

/// One block a curve, in the order of the panels. Points that are not finite leave a gap.
inline std::string plot_data(const figure& f) {
  std::string text;
  for (const auto& panel : f.panels) {
    for (const auto& curve : panel.curves) {
      text += fmt::format("# {}: {}\n", panel.title, curve.label);
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double error = i < curve.error.size() && std::isfinite(curve.error[i]) ? curve.error[i] : 0.0;
        const bool finite = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
        text += finite ? fmt::format("{:.10g} {:.10g} {:.10g}\n", curve.x[i], curve.y[i], error)
                       : "NaN NaN NaN\n";
      }
      text += "\n\n";
    }
  }
  return text;
}

inline std::string plot_script(const figure& f) {
  // Okabe and Ito's colours and two more, with a point type each, so that the picture reads in grey too.
  static constexpr const char* colours[] = {"#D55E00", "#0072B2", "#56B4E9", "#009E73", "#CC79A7",
                                            "#E69F00", "#000000", "#999999", "#661100", "#F0E442"};
  static constexpr int points[] = {7, 5, 4, 9, 8, 13, 2, 6, 12, 10};
  std::string text = fmt::format(
      "# gnuplot -e \"kind='svg'; target='{0}.svg'\" {0}.gp\n"
      "if (kind eq 'svg') {{ set terminal svg size {1},{2} background 'white' font 'sans,13' noenhanced }}\n"
      "if (kind eq 'png') {{ set terminal pngcairo size {1},{2} background 'white' font 'sans,11' noenhanced "
      "}}\n"
      "set output target\nset grid lw 0.5 lc '#cccccc'\nset key opaque box lc '#cccccc'\n",
      f.name, f.width, f.height);
  if (f.panels.size() > 1) text += fmt::format("set multiplot layout 1,{}\n", f.panels.size());
  std::size_t block = 0;
  for (const auto& panel : f.panels) {
    text += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset yrange {}\n", quoted(panel.title),
                        quoted(panel.x_label), quoted(panel.y_label), panel.y_range);
    // Errors fall with cost, so that there is room on the right; lines may go anywhere.
    text += !panel.log_log ? "unset logscale\nset key outside top center horizontal\n"
            : panel.linear_y
                ? "unset logscale\nset logscale x\nset format '%g'\nset key inside right bottom\n"
                : "set logscale xy\nset format x '%g'\nset format y '%.0e'\nset key inside right top\n";
    for (std::size_t j = 0; j < panel.curves.size(); ++j, ++block) {
      const auto& curve = panel.curves[j];
      const std::string data = fmt::format("'{}.dat' index {}", f.name, block);
      const std::string colour = fmt::format("lc '{}'", colours[j % std::size(colours)]);
      text += j == 0 ? "plot " : ", ";
      if (panel.log_log) {
        const int point = points[j % std::size(points)];
        text +=
            fmt::format("{} using 1:2:3 with yerrorlines {} lw {} pt {} ps {} title {}", data, colour,
                        curve.emphasised ? 3 : 1.5, point, curve.emphasised ? 1.4 : 1.0, quoted(curve.label));
      } else {
        text += fmt::format("{} using 1:2 with lines {} lw {} title {}", data, colour,
                            curve.emphasised ? 2.5 : 0.9, quoted(curve.label));
      }
    }
    text += "\n";
  }
  return text + (f.panels.size() > 1 ? "unset multiplot\n" : "");
}

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
