// SPDX-License-Identifier: BSL-1.0
// The exhibits of the paper, in its order.
#pragma once

#include <string>
#include <vector>

#include "exhibit.hpp"
#include "setting.hpp"

namespace nysalt::program::paper {

/// One exhibit that is still to be computed, and about how many seconds that takes on one core.
struct planned {
  const char* what;
  double seconds;
  exhibit (*make)(const setting&);
};

/// linear, deterministic, langevin.
struct part_of_paper {
  std::string name;
  std::string title;
  std::vector<planned> exhibits;
};
const std::vector<part_of_paper>& parts_of_paper();

// Section 4, linear systems.
exhibit linear_optimum(const setting& its);
exhibit printed_constraint(const setting& its);
exhibit linear_stability(const setting& its);
exhibit linear_langevin_optimum(const setting& its);
exhibit linear_langevin_order(const setting& its);

// Section 5.2, the chain alone.
exhibit table_1(const setting& its);
exhibit parameters_against_omega(const setting& its);
exhibit convergence_in_trajectories(const setting& its);
exhibit accuracy_on_short_times(const setting& its);
exhibit accuracy_on_long_times(const setting& its);
exhibit energy_transitions(const setting& its);
exhibit energies_at_200(const setting& its);
exhibit energies_at_400(const setting& its);
exhibit largest_stable_step(const setting& its);
exhibit other_starts(const setting& its);
exhibit growth_of_error(const setting& its);
exhibit conserved_action(const setting& its);

// Section 5.3, the chain in a bath.
exhibit parameters_against_gap(const setting& its);
exhibit convergence_in_noisy_trajectories(const setting& its);
exhibit errors_along_paths(const setting& its);
exhibit law_of_energy(const setting& its);
exhibit autocovariance_of_energy(const setting& its);
exhibit run_times(const setting& its);

}  // namespace nysalt::program::paper
