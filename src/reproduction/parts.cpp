// SPDX-License-Identifier: BSL-1.0
#include "parts.hpp"

namespace nysalt::program::paper {

const std::vector<part_of_paper>& parts_of_paper() {
  static const std::vector<part_of_paper> all{
      {"linear",
       "Linear systems",
       {{"optimum", 0.1, linear_optimum},
        {"constraint", 0.1, printed_constraint},
        {"stability", 0.1, linear_stability},
        {"Langevin optimum", 0.1, linear_langevin_optimum},
        {"Langevin order", 0.1, linear_langevin_order}}},
      {"deterministic",
       "The chain without bath",
       {{"table 1", 20, table_1},
        {"parameters against omega", 5, parameters_against_omega},
        {"convergence in M", 20, convergence_in_trajectories},
        {"accuracy at T = 0.5", 10, accuracy_on_short_times},
        {"accuracy at T = 100", 60, accuracy_on_long_times},
        {"energy transitions", 10, energy_transitions},
        {"energies at gap 200", 5, energies_at_200},
        {"energies at gap 400", 2, energies_at_400},
        {"largest stable step", 5, largest_stable_step},
        {"other starts", 5, other_starts},
        {"growth of the error", 2, growth_of_error},
        {"actions over long times", 10, conserved_action}}},
      {"langevin",
       "The chain in a bath",
       {{"parameters against the gap", 200, parameters_against_gap},
        {"convergence in M, in a bath", 30, convergence_in_noisy_trajectories},
        {"errors along paths", 120, errors_along_paths},
        {"distribution", 120, law_of_energy},
        {"autocovariance", 60, autocovariance_of_energy},
        {"run times", 10, run_times}}}};
  return all;
}

}  // namespace nysalt::program::paper
