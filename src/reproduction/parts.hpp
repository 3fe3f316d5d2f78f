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
exhibit linear_optimum(const setting& setup);
exhibit printed_constraint(const setting& setup);
exhibit linear_stability(const setting& setup);
exhibit linear_langevin_optimum(const setting& setup);
exhibit linear_langevin_order(const setting& setup);

// Section 5.2, the chain without a bath.
exhibit table_1(const setting& setup);
exhibit parameters_against_omega(const setting& setup);
exhibit convergence_in_trajectories(const setting& setup);
exhibit accuracy_on_short_times(const setting& setup);
exhibit accuracy_on_long_times(const setting& setup);
exhibit energy_transitions(const setting& setup);
exhibit energies_at_200(const setting& setup);
exhibit energies_at_400(const setting& setup);
exhibit largest_stable_step(const setting& setup);
exhibit other_starts(const setting& setup);
exhibit growth_of_error(const setting& setup);
exhibit conserved_action(const setting& setup);

// Section 5.3, the chain in a bath.
exhibit parameters_against_gap(const setting& setup);
exhibit convergence_in_noisy_trajectories(const setting& setup);
exhibit errors_along_paths(const setting& setup);
exhibit law_of_energy(const setting& setup);
exhibit autocovariance_of_energy(const setting& setup);
exhibit run_times(const setting& setup);

}  // namespace nysalt::program::paper
