// SPDX-License-Identifier: BSL-1.0
// Pictures of errors against costs, and of distributions with that of the reference.
#pragma once

#include <string>
#include <vector>

#include "comparison/ranking.hpp"
#include "plot.hpp"

namespace nysalt::program {

/// All methods, or where they are too many for a picture the cheapest of both kinds at the first level.
std::vector<std::string> drawn_methods(const comparison& all, std::size_t metric);
/// Against evaluations, and against seconds.
std::vector<figure> pictures_of_errors(const comparison& all, std::size_t metric);
/// One for each step; none if the metric is not of a distribution.
std::vector<figure> pictures_of_laws(const comparison& all, std::size_t metric);
/// One for each step: the energy's error and the trajectories that survive, against time; none if energies
/// were not followed.
std::vector<figure> pictures_of_energies(const comparison& all);

}  // namespace nysalt::program
