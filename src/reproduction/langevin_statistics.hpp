// SPDX-License-Identifier: BSL-1.0
// Statistics of the total stiff energy in a bath: how they are gathered, and their distances by method and
// gap.
#pragma once

#include <string>
#include <vector>

#include "comparison/seeds.hpp"
#include "sweep.hpp"

namespace nysalt::program::paper {

inline constexpr const char* stiff_energy = "stiff_energy";

/// Over [0, 40]; each ensemble has starts and noise of its own.
statistics_plan plan_of_statistics(const setting& setup, double step, role whose, int ensemble = 0);

/// BAOAB, BAOAB with half steps and NySALT, without errors yet.
std::vector<named_curve> empty_curves(const std::vector<double>& gaps);
/// The same methods.
std::vector<method> methods_at(const setting& setup, const std::string& start, double gap);

/// Throws if the curve has no such point.
estimate at_gap(const error_curve& curve, double gap);

/// A row for each gap, a column for each method, and the sampling floor.
table table_of_laws(const std::vector<named_curve>& methods, double floor);
panel panel_of_laws(const std::vector<named_curve>& methods, const std::string& title,
                    const std::string& label, double floor);

}  // namespace nysalt::program::paper
