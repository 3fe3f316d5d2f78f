// SPDX-License-Identifier: BSL-1.0
// Energies of the three stiff springs along recorded trajectories of the chain, and their errors.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exhibit.hpp"
#include "setting.hpp"

namespace nysalt::program::paper {

/// The observables that such records hold.
inline const std::vector<std::string> stiff{"stiff_energy_1", "stiff_energy_2", "stiff_energy_3"};
using energies = std::array<double, 3>;

energies energies_at(const record& run, std::size_t sample);
double total(const energies& I);

/// (5.8) without the factor delta: sum_j |I_j - I_j^ref| / I^ref.
double energy_error(const energies& I, const energies& reference);
/// (5.9) without the factor delta.
double angle_error(const energies& I, const energies& reference);

using energy_distance = double (*)(const energies&, const energies&);

/// Mean over trajectories at each sample; 2, the most there can be of energies, once one has diverged.
std::vector<double> curve_against(const std::vector<record>& runs, const std::vector<record>& reference,
                                  energy_distance error, bool frozen = false);
/// Of each trajectory the mean over the samples up to `last`.
std::vector<double> means_up_to(const std::vector<record>& runs, const std::vector<record>& reference,
                                energy_distance error, std::size_t last, bool frozen = false);

/// 0, sample, 2 sample, ...
std::vector<double> times(std::size_t samples, double sample);
/// The total stiff energy and those of the three springs along one trajectory.
panel energies_panel(const record& run, double sample, const std::string& title);

/// The reference of long runs: the same starts, omega h = .05, or a part of it to see its own error.
std::vector<record> reference_runs(const setting& setup, const prepared_problem& system, double sample,
                                   double horizon, std::int64_t count, int finer = 1);

}  // namespace nysalt::program::paper
