// SPDX-License-Identifier: BSL-1.0
// Cost and error of a method: always together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "plot.hpp"
#include "table.hpp"

namespace nysalt {

/// A method at a step: what it costs, and how far it errs.
struct work_precision_row {
  std::string method;           ///< name; rows of one name make a curve
  double step;                  ///< h
  double evaluations_per_time;  ///< force evaluations of a trajectory per unit time, counted
  double seconds_per_time;      ///< measured, of a trajectory per unit time
  estimate error;               ///< NaN if every trajectory diverged
  std::int64_t diverged;        ///< number of trajectories that did
  std::int64_t trajectories;    ///< number of all
  bool learned = false;         ///< whether it is to be emphasised
  bool counts = true;           ///< false where the error says nothing: beyond a limit; drawn hollow
};

/// Error against a cost, a curve a method, from cheap to expensive; rows without a finite error leave a gap.
/// What is learned is emphasised, and the method of that name. Levels and a front are for the caller to add.
panel work_precision_panel(std::vector<work_precision_row> rows, const std::string& emphasised,
                           const std::string& x_label, double work_precision_row::*cost);

/// The Pareto front as a curve of that panel: `front` are the places in `rows` of those that no other beats
/// in both. Throws std::out_of_range if there is no such place.
curve front_curve(const std::vector<work_precision_row>& rows, std::vector<std::size_t> front,
                  double work_precision_row::*cost, const std::string& label = "Pareto front");

}  // namespace nysalt
