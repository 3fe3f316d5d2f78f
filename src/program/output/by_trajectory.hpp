// SPDX-License-Identifier: BSL-1.0
// Rows of several trajectories, in the order in which they were computed, put in that of the trajectories.
#pragma once

#include <filesystem>

namespace nysalt::program {

/// Writes the lines of one table of samples into another: its head, and the rows by the trajectory that each
/// begins with; those of one trajectory keep their order. Memory: 24 bytes for each stretch of a trajectory.
/// Throws std::runtime_error if it cannot be read or written; then an older file is as it was.
void put_by_trajectory(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace nysalt::program
