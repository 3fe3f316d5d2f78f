// SPDX-License-Identifier: BSL-1.0
// The motion itself, by an accurate method: its kinetic energy, and states along it.
#pragma once

#include <cstdint>
#include <vector>

#include "nysalt/judgement.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt::detail {

using states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// Median of some numbers, which are put into another order; 0 of none.
double median_of(std::vector<double>& numbers);

/// f(T()) with T a pack if there are enough trajectories for its lanes and a pack of states fits into the
/// cache; else with T double.
decltype(auto) in_lanes_if_filled(const model& system, std::int64_t trajectories, const auto& f) {
  constexpr Eigen::Index large = 20'000;
  if (trajectories < default_lanes / 4 || size(system) > large) return f(double());
  return with_scalar_of(system, f);
}

/// What an accurate motion shows.
struct accurate_motion {
  double kinetic_energy = 0.0;  // median over trajectories and times; 0: not known, as where it still rises
  states seen;                  // states along it, typical ones first
  double step = 0.0;            // the coarsest that was tried at which the energy stays
  bool is_followed = true;      // false: at none it does
};

/// Finest step of the accurate motion, in steps of the trial.
constexpr double finest_step = 1.0 / 512.0;

/// Of the system without a bath, as long as the trial or shorter: at the coarsest of some steps at which the
/// energy stays. Cost: some 10^5 evaluations for each step that is tried, nine at most.
accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options);

}  // namespace nysalt::detail
