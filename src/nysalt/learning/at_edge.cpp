// SPDX-License-Identifier: BSL-1.0
// Polls along the axes of Gauss-Newton's matrix.
#include "at_edge.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace nysalt {

Eigen::VectorXd descend_at_edge(const objective& loss,
                                const std::function<bool(const Eigen::VectorXd&)>& admits,
                                Eigen::VectorXd theta, const std::vector<Eigen::Index>& free,
                                int most_passes) {
  constexpr double longest = 0.3;  // coefficients are of order one
  constexpr double shortest = 1e-3;
  if (free.empty()) return theta;
  squares here = loss(theta);
  int passes = 1;
  double length = 1.0;
  while (length > shortest && passes < most_passes && here.is_finite() && here.value > 0.0) {
    const Eigen::MatrixXd of_free = here.normal_matrix(free, free);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(of_free);
    const double least = 1e-12 * axes.eigenvalues().maxCoeff();
    bool has_moved = false;
    for (Eigen::Index k = 0; k < axes.eigenvalues().size() && passes < most_passes; ++k) {
      const double reach = std::sqrt(here.value / std::max(axes.eigenvalues()[k], least));
      const bool is_uphill = axes.eigenvectors().col(k).dot(here.half_gradient(free)) > 0.0;
      for (const double sign : {is_uphill ? -1.0 : 1.0, is_uphill ? 1.0 : -1.0}) {
        Eigen::VectorXd next = theta;
        next(free) += sign * std::min(length * reach, longest) * axes.eigenvectors().col(k);
        if (!admits(next)) continue;
        const squares there = loss(next);
        ++passes;
        if (!(there.value < here.value)) continue;
        theta = next;
        here = there;
        has_moved = true;
        break;
      }
    }
    length = has_moved ? std::min(1.0, 1.5 * length) : 0.5 * length;
  }
  return theta;
}

}  // namespace nysalt
