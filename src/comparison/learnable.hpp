// SPDX-License-Identifier: BSL-1.0
// What a system makes of a plan to learn.
#pragma once

#include <optional>

#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/problem.hpp"

namespace nysalt::program {

/// A problem of learning, and how far the energies of its data go.
struct learnable {
  learning_problem problem;
  std::optional<energy_range> energies;
};

}  // namespace nysalt::program
