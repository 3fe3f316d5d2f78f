// SPDX-License-Identifier: BSL-1.0
// Bars against the roof, and ratios against their targets, by gnuplot.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "nysalt/report/write_file.hpp"
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
  for (const std::string runner :
       {"ours", "hand-written", "ours, word as data", "odeint packs", "odeint arrays"}) {
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
    bar one{j.row.name, margin(j.found), j.beside ? margin(*j.beside) : NAN};
    if (j.row.compiler != "g++") one = {j.row.name, NAN, margin(j.found)};
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
  // Bars lie: long names are read from the left. Two a place, one for each compiler.
  const auto panel = [](std::size_t index, const char* title, const char* range) {
    const auto bars = [&](int column, double shift, const char* colour, const char* name) {
      return fmt::format(
          "'performance.dat' index {0} using (${1}*0.5):($1+({2})):(${1}*0.5):(0.19):ytic(2) with boxxyerror "
          "fs solid lc '{3}' title '{4}'",
          index, column, shift, colour, name);
    };
    return fmt::format("set title '{}'\nset xrange {}\nplot {}, {}\n", title, range,
                       bars(3, -0.2, "#0072B2", "g++"), bars(4, 0.2, "#E69F00", "clang++"));
  };
  const std::string script = fmt::format(
      "# gnuplot -e \"kind='svg'; target='performance.svg'\" performance.gp\n"
      "if (kind eq 'svg') {{ set terminal svg size 1000,760 background 'white' font 'sans,13' noenhanced }}\n"
      "if (kind eq 'png') {{ set terminal pngcairo size 1000,760 background 'white' font 'sans,11' "
      "noenhanced "
      "}}\n"
      "set output target\nset grid x lw 0.5 lc '#cccccc'\nset yrange [*:*] reverse\nset lmargin 52\n"
      "set offsets 0,0,0.6,0.6\nset ytics scale 0\nset arrow 1 from first 1, graph 0 to first 1, graph 1 "
      "nohead "
      "lw 2 lc '#D55E00' front\nset multiplot\nset origin 0,0.62\nset size 1,0.38\n{}"
      "unset key\nset origin 0,0\nset size 1,0.62\nset logscale x\n{}unset multiplot\n",
      panel(0, "Speed of a two-stage step on an ensemble; 1 is the roof", "[0:1.05]"),
      panel(1, "How far beyond its target; 1 is just met", "[*:*]"));
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
