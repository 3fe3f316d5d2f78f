// SPDX-License-Identifier: BSL-1.0
// Contents of a picture.
#pragma once

#include <string>
#include <vector>

namespace nysalt {

/// Points of a method, or of anything else with a name in the key.
struct curve {
  std::string label;            ///< name in the key
  std::vector<double> x;        ///< abscissas
  std::vector<double> y;        ///< as many; what is not finite leaves a gap
  std::vector<double> error{};  ///< of y, drawn as bars if given
  bool emphasised = false;      ///< solid and thick; what is learned
  std::vector<bool> hollow{};   ///< points that are shown but do not count, as beyond a limit
  bool dashed = false;          ///< of long dashes, if it is not a front
  bool points_only = false;     ///< not joined
  bool front = false;  ///< a Pareto front, from cheap to expensive: dotted black steps behind the others
};

/// A horizontal line to compare with: the null model, the floor of sampling.
struct level {
  std::string label;  ///< name in the key; empty: none
  double y;           ///< where the line is
};

/// A part of the x axis, shaded over the whole height. Intervals of one label have one colour, and one entry
/// in the key.
struct shaded_interval {
  std::string label;  ///< name in the key
  double low;         ///< where it begins, on the x axis
  double high;        ///< where it ends
};

/// A pair of axes and what is drawn on them.
struct panel {
  std::string title;                         ///< written above
  std::string x_label;                       ///< written at the x axis
  std::string y_label;                       ///< written at the y axis
  bool log_log = false;                      ///< with points; else plain lines
  std::vector<curve> curves;                 ///< in the order of the key
  std::string y_range = "[*:*]";             ///< as gnuplot reads it; if not given, what the points need
  bool linear_y = false;                     ///< where log_log would be, of what does not go to 0
  bool linear_x = false;                     ///< where log_log would be, of a time
  bool points = false;                       ///< where axes are plain: points with bars as well as lines
  std::vector<level> levels{};               ///< lines to compare with
  std::vector<shaded_interval> intervals{};  ///< shaded parts, behind all else
};

/// A picture of one panel or of several; draw() makes files of it.
struct figure {
  std::string name;           ///< of the files: letters, digits, _ and -
  std::vector<panel> panels;  ///< side by side
  int width = 640;            ///< in pixels, of which a telephone has more than half
  int height = 400;           ///< in pixels; a key below the panels is added to it
};

}  // namespace nysalt
