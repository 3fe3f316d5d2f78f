// SPDX-License-Identifier: BSL-1.0
// A problem of learning, prepared for a plan.
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
