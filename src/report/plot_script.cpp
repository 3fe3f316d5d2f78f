// SPDX-License-Identifier: BSL-1.0
#include "plot_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "curve_drawing.hpp"
#include "page_files.hpp"
#include "quoted.hpp"
#include "terminal.hpp"

namespace nysalt::detail {

namespace {

constexpr const char* hollow_label = "hollow: not ranked";
constexpr const char* style_of_levels = "lc '#777777' lw 1.2 dt (7,5)";

/// Fronts first, so that they lie behind, and what is emphasised last.
std::string plot_command(const panel& plot, const std::string& name, std::size_t first_block) {
  std::vector<std::string> elements;
  for (const auto& level : plot.levels) {  // unseen: for the range; what is seen is an arrow, of full width
    elements.push_back(fmt::format("{:.10g} with dots lc 'white' notitle", level.y));
  }
  const auto draw_if = [&](auto wanted) {
    for (std::size_t j = 0; j < plot.curves.size(); ++j) {
      if (!wanted(plot.curves[j])) continue;
      const auto drawing = drawing_of(plot, j, fmt::format("'{}.dat' index {}", name, first_block + j));
      elements.insert(elements.end(), drawing.begin(), drawing.end());
    }
  };
  draw_if([](const curve& c) { return c.front; });
  draw_if([](const curve& c) { return !c.front && !c.emphasised; });
  draw_if([](const curve& c) { return !c.front && c.emphasised; });
  for (std::size_t j = 0; j < plot.curves.size(); ++j) elements.push_back(key_entry(plot, j));
  if (std::ranges::any_of(plot.curves, has_hollow))
    elements.push_back(fmt::format("keyentry with points lc '#555555' pt 6 title {}", quoted(hollow_label)));
  for (const auto& level : plot.levels) {
    if (!level.label.empty())
      elements.push_back(
          fmt::format("keyentry with lines {} title {}", style_of_levels, quoted(level.label)));
  }
  const auto labels = labels_of_intervals(plot);
  for (std::size_t j = 0; j < labels.size(); ++j) {
    elements.push_back(
        fmt::format("keyentry with boxes {} title {}", style_of_intervals(j), quoted(labels[j])));
  }
  return elements.empty() ? "" : fmt::format("plot {}\n", fmt::join(elements, ", \\\n  "));
}

/// Names in the key, in its order.
std::vector<std::string> key_labels(const panel& plot) {
  std::vector<std::string> labels;
  for (const auto& curve : plot.curves) labels.push_back(curve.label);
  if (std::ranges::any_of(plot.curves, has_hollow)) labels.push_back(hollow_label);
  for (const auto& level : plot.levels) {
    if (!level.label.empty()) labels.push_back(level.label);
  }
  std::ranges::copy(labels_of_intervals(plot), std::back_inserter(labels));
  return labels;
}

/// As many columns of the key as fit below a panel. gnuplot takes .6 of the size of the font, 14, for the
/// width of a character, and a sample of three of them, with space around, stands before a name.
std::size_t key_columns(const panel& plot, int width) {
  std::size_t longest = 0;
  for (const auto& label : key_labels(plot)) longest = std::max(longest, columns_of(label));
  constexpr double character = 0.6 * 14.0;
  constexpr double share = 0.85;  // of the panel, between the margins
  const double entry = character * static_cast<double>(longest + 6);
  return static_cast<std::size_t>(std::max(1.0, share * width / entry));
}

int width_of_panel(const figure& f) {
  return f.width / static_cast<int>(std::max<std::size_t>(f.panels.size(), 1));
}

/// Of the highest key below a panel, in pixels: lines of 19, and one for the space around.
int key_height(const figure& f) {
  std::size_t most = 0;
  for (const auto& panel : f.panels) {
    const std::size_t columns = key_columns(panel, width_of_panel(f));
    most = std::max(most, (key_labels(panel).size() + columns - 1) / columns);
  }
  return 19 * static_cast<int>(most + 1);
}

/// Behind all else; the later over the earlier.
std::string shading(const panel& plot) {
  const auto labels = labels_of_intervals(plot);
  std::string text = "unset object\n";
  for (std::size_t i = 0; i < plot.intervals.size(); ++i) {
    const auto& one = plot.intervals[i];
    const auto label = std::find(labels.begin(), labels.end(), one.label) - labels.begin();
    text += fmt::format(
        "set object {} rectangle from first {:.10g}, graph 0 to first {:.10g}, graph 1 behind clip {}\n",
        i + 1, one.low, one.high, style_of_intervals(static_cast<std::size_t>(label)));
  }
  return text;
}

/// What share/report/axes.gp takes; an axis is logarithmic if it has a positive point.
std::string axes_in_question(const panel& plot, const std::string& data, std::size_t first) {
  const auto has_positive = [&](std::vector<double> curve::*field) {
    return std::ranges::any_of(plot.curves, [&](const curve& one) {
      return std::ranges::any_of(one.*field, [](double x) { return std::isfinite(x) && x > 0.0; });
    });
  };
  const bool log_x = plot.log_log && !plot.linear_x && has_positive(&curve::x) && has_positive(&curve::y);
  const bool log_y = plot.log_log && !plot.linear_y && has_positive(&curve::y);
  constexpr double none = -999.0;  // below the logarithm of any number
  double lowest = -none;
  double highest = none;
  for (const auto& level : plot.levels) {
    if (!(level.y > 0.0)) continue;
    lowest = std::min(lowest, std::log10(level.y));
    highest = std::max(highest, std::log10(level.y));
  }
  return fmt::format(
             "data = '{}'\nfirst = {}\nlast = {}\nlog_x = {}\nlog_y = {}\nlowest = {}\nhighest = {}\n", data,
             first, first + plot.curves.size() - 1, log_x ? 1 : 0, log_y ? 1 : 0, lowest, highest) +
         std::string(page_files::axes);
}

std::string axes(const panel& axis_pair, int width, const std::string& data, std::size_t first) {
  const bool log_y = axis_pair.log_log && !axis_pair.linear_y;
  std::string text = fmt::format(
      "set title {}\nset xlabel {} offset 0,1\nset ylabel {}\nset format x '%g'\nset format y '{}'\n"
      "set key outside bottom center horizontal maxcols {} Left reverse samplen 3\nunset label\nunset "
      "arrow\n",
      quoted(axis_pair.title), quoted(axis_pair.x_label), quoted(axis_pair.y_label), log_y ? "%.0te%T" : "%g",
      key_columns(axis_pair, width));
  text += shading(axis_pair) + axes_in_question(axis_pair, data, first) + "\n";
  for (const auto& level : axis_pair.levels) {
    text += fmt::format("set arrow from graph 0, first {0:.10g} to graph 1, first {0:.10g} nohead back {1}\n",
                        level.y, style_of_levels);
  }
  return axis_pair.y_range == "[*:*]" ? text : text + fmt::format("set yrange {}\n", axis_pair.y_range);
}

}  // namespace

std::string plot_data(const figure& f) {
  std::string text;
  for (const auto& panel : f.panels) {
    for (const auto& curve : panel.curves) {
      text += fmt::format("# {}\n", on_one_line(fmt::format("{}: {}", panel.title, curve.label)));
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double error = i < curve.error.size() && std::isfinite(curve.error[i]) ? curve.error[i] : 0.0;
        const bool finite = std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]);
        text +=
            finite ? fmt::format("{:.10g} {:.10g} {:.10g}", curve.x[i], curve.y[i], error) : "NaN NaN NaN";
        if (has_hollow(curve)) text += i < curve.hollow.size() && curve.hollow[i] ? " 1" : " 0";
        text += "\n";
      }
      text += "\n\n";
    }
  }
  return text;
}

std::string plot_script(const figure& f) {
  std::string text = fmt::format(
      "# gnuplot -e \"kind='svg'; target='{0}.svg'\" {0}.gp\n"
      "if (kind eq 'svg') {{ set terminal svg size {1},{2} dashlength 1.3 background 'white' font 'sans,14' "
      "noenhanced }}\n"
      "if (kind eq 'png') {{ set terminal pngcairo size {1},{2} pointscale 1.5 dashlength 2 background "
      "'white' font 'sans,11' noenhanced "
      "}}\n"
      "if (exists('target')) {{ set output target }}\nset grid lw 0.5 lc '#cccccc'\nset key opaque box lc "
      "'#cccccc'\nset samples 2\n",
      f.name, f.width, f.height + key_height(f));
  if (f.panels.size() > 1) text += fmt::format("set multiplot layout 1,{}\n", f.panels.size());
  std::size_t block = 0;
  for (const auto& panel : f.panels) {
    text += axes(panel, width_of_panel(f), f.name + ".dat", block) + plot_command(panel, f.name, block);
    block += panel.curves.size();
  }
  return text + (f.panels.size() > 1 ? "unset multiplot\n" : "");
}

}  // namespace nysalt::detail
