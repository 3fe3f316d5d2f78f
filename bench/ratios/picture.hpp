// SPDX-License-Identifier: BSL-1.0
// Bars against the roof, and ratios against their targets, by gnuplot.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../../src/report/write_file.hpp"
#include "row.hpp"

namespace nysalt::bench {

struct bar {
  std::string label;
  double first;   // g++
  double second;  // clang++; not finite: no bar
};

/// Speed in units of the roof: the kernel with the same mix of operations.
inline std::vector<bar> bars_under_the_roof(const measurements& gnu, const measurements& clang) {
  const auto share = [](const measurements& all, const std::string& runner) {
    return paired_ratio(all.of("ensemble", "same mix"), all.of("ensemble", runner)).value;
  };
  std::vector<bar> result;
  for (const std::string runner : {"ours", "hand-written", "odeint packs", "odeint arrays"}) {
    result.push_back({runner, share(gnu, runner), share(clang, runner)});
  }
  return result;
}

/// How far a ratio is on the good side of its target: 1 is just met.
inline std::vector<bar> margins(const std::vector<judged_row>& rows) {
  std::vector<bar> result;
  for (const auto& j : rows) {
    const auto margin = [&](const ratio& r) {
      return j.row.measure == measure::speed ? r.value / *j.row.bound : *j.row.bound / r.value;
    };
    const std::string name = j.row.name + (j.said.holds ? "" : " (?)");
    bar one{name, margin(j.found), j.beside ? margin(*j.beside) : NAN};
    if (j.row.compiler != "g++") one = {name, NAN, margin(j.found)};
    result.push_back(one);
  }
  return result;
}

namespace detail {
inline std::string block(const std::vector<bar>& bars) {
  std::string text;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    text += fmt::format("{} \"{}\" {:.5g} {:.5g}\n", i, bars[i].label, bars[i].first, bars[i].second);
  }
  return text + "\n\n";
}
}  // namespace detail

/// performance.dat, .gp, .svg and .png in the folder. False if gnuplot is not there.
inline bool draw(const std::vector<bar>& shares, const std::vector<bar>& margins,
                 const std::filesystem::path& folder) {
  write_file(folder / "performance.dat", detail::block(shares) + detail::block(margins));
  // Bars lie, so that long names can be read. Two a place, one for each compiler, from a line on: 0 or 1.
  const auto panel = [](std::size_t index, const char* title, const char* place, int from) {
    const auto bars = [&](int column, double shift, const char* colour, const char* name) {
      return fmt::format(
          "'performance.dat' index {0} using ({4}):($1{2:+}):({4}):{1}:($1{2:+}-0.18):($1{2:+}+0.18) "
          "with boxxyerror fs solid lc '{3}' title '{5}'",
          index, column, shift, colour, from, name);
    };
    return fmt::format(
        "set title '{}'\n{}\nplot {}, {}, 'performance.dat' index {} using ({}):1:ytic(2) with dots lc "
        "'white' notitle\n",
        title, place, bars(3, -0.18, "#0072B2", "g++"), bars(4, 0.18, "#E69F00", "clang++"), index, from);
  };
  const std::string script = fmt::format(
      "# gnuplot -e \"kind='svg'; target='performance.svg'\" performance.gp\n"
      "if (kind eq 'svg') {{ set terminal svg size 1000,800 background 'white' font 'sans,13' noenhanced }}\n"
      "if (kind eq 'png') {{ set terminal pngcairo size 1000,800 background 'white' font 'sans,11' "
      "noenhanced "
      "}}\n"
      "set output target\nset datafile missing 'nan'\nset grid x lw 0.5 lc '#cccccc'\n"
      "set yrange [*:*] reverse\nset offsets 0,0,0.7,0.7\nset ytics scale 0\nset lmargin 54\n"
      "set key outside right top\nset rmargin 18\n"
      "set arrow 1 from first 1, graph 0 to first 1, graph 1 nohead lw 2 lc '#D55E00' front\n"
      "set multiplot\n{}{}unset multiplot\n",
      panel(0, "Speed of a two-stage step on an ensemble: 1 is the roof",
            "set origin 0,0.66\nset size 1,0.34\nset xrange [0:1.1]", 0),
      panel(1, "Beyond its target (right of the line) or short of it, by which factor",
            "set origin 0,0\nset size 1,0.66\nset logscale x 2\nset xrange [0.25:8]", 1));
  write_file(folder / "performance.gp", script);
  bool drawn = true;
  for (const std::string kind : {"svg", "png"}) {
    const std::string command =
        fmt::format("cd '{}' && gnuplot -e \"kind='{}'; target='performance.{}'\" performance.gp",
                    folder.string(), kind, kind);
    drawn = std::system(command.c_str()) == 0 && drawn;
  }
  return drawn;
}

}  // namespace nysalt::bench
