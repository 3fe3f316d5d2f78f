// SPDX-License-Identifier: BSL-1.0
// What is known of data before a fit.
#pragma once

#include "nysalt/flow_map_data.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/metric.hpp"

namespace nysalt::detail {

/// Whether the first trajectory, which rank 0 has, is the same. In a bath other noise makes another of the
/// same start.
bool begin_alike(const flow_map_data& a, const flow_map_data& b);

/// The root mean square error of the reference, where it was checked: against its finer self, along noisy
/// paths with error_over_difference.
double error_of_reference(const flow_map_data& data, const metric& measure);

/// The number of steps of the shortest trajectory.
int shortest_of(const flow_map_data& data);

/// The mean over windows and times of each squared residual of the distance from where a window begins.
Eigen::VectorXd motion_in(const flow_map_data& data, const metric& measure, const after_steps_options& how);

/// The stages of a search use only some of the trajectories, 16 at least, where all have more
/// coordinates together than are needed to find minima: a hundred trajectories of a dozen.
int trajectories_apart(const flow_map_data& data, Eigen::Index coordinates);

}  // namespace nysalt::detail
