// SPDX-License-Identifier: BSL-1.0
// trace/2 of a method over z = h omega, as numbers and as a picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison/stability.hpp"
#include "figure.hpp"

namespace nysalt::program {

struct stability_curve {
  std::vector<double> z;
  std::vector<double> half_trace;
};
/// From 0 to a bit beyond the last window, or beyond highest_z, though not to where windows are dots.
stability_curve stability_curve_of(const nysalt::method& method, const stability_chart& chart,
                                   double highest_z);

/// Lines z,half_trace.
std::string table_of(const stability_curve& curve);

/// The system's frequencies at a step, to be marked in the picture.
struct marked_step {
  std::string system;
  double step;
  std::vector<frequency_band> bands;
};
panel stability_panel(const std::string& name, const stability_curve& curve, const stability_chart& chart,
                      const std::optional<marked_step>& marked);

}  // namespace nysalt::program
