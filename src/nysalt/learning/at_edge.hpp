// SPDX-License-Identifier: BSL-1.0
// A descent among admitted points only, along the edge where it must.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

#include "nysalt/losses/squares.hpp"

namespace nysalt {

/// From an admitted theta to one that no poll lowers: steps to either side along the eigenvectors of
/// Gauss-Newton's matrix, each as long as the loss at its bottom would ask for, then shorter. What is not
/// admitted is not taken, so that it slides along an edge. Cost: a pass with derivatives for each poll that
/// is admitted, `most_passes` at most.
Eigen::VectorXd descend_at_edge(const objective& loss,
                                const std::function<bool(const Eigen::VectorXd&)>& admits,
                                Eigen::VectorXd theta, const std::vector<Eigen::Index>& free,
                                int most_passes = 400);

}  // namespace nysalt
