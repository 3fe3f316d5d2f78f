// SPDX-License-Identifier: BSL-1.0
// What a picture shows.
#pragma once

#include <string>
#include <vector>

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

/// A part of the x axis, shaded over the whole height. Those of one label have one colour, and one entry in
/// the key.
struct stretch {
  std::string label;
  double low;
  double high;
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
  std::vector<stretch> stretches{};
};

struct figure {
  std::string name;           // of the files: letters, digits, _ and -
  std::vector<panel> panels;  // side by side
  int width = 800;            // a key that stands beside a panel is added to it
  int height = 520;
};

}  // namespace nysalt
