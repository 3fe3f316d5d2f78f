// SPDX-License-Identifier: BSL-1.0
// Modes of a periodic square lattice.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace nysalt::sampling_benchmark {

/// |sum over x of q_x exp(-i k x)|^2/L^2 for all L x L modes k, by rows; side L.
void power_spectrum(const Eigen::VectorXd& q, Eigen::Index side, Eigen::VectorXd& spectrum);

/// The mean over the modes that the symmetries of the square (reflections, and rows for columns) carry into
/// each other, at each of them.
Eigen::VectorXd over_symmetries(const Eigen::VectorXd& of_modes, Eigen::Index side);

}  // namespace nysalt::sampling_benchmark
