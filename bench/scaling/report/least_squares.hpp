// SPDX-License-Identifier: BSL-1.0
// What work costs, from how long it took.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace nysalt::bench {

struct cost {
  double value = 0.0;
  double standard_error = 0.0;
};

/// It took y = sum_k c_k x_k, with the c_k to be found.
struct observation {
  std::vector<double> x;
  double y;
};

/// c that minimises sum ((y - sum_k c_k x_k)/y)^2: a relative error counts alike in small and large. Costs
/// are not negative: the lowest that would be is 0, and the others are fitted again. Standard errors are
/// those of linear least squares with the scatter s^2 = sum/(observations - costs) that is left; NaN if none
/// can be. Throws std::runtime_error if there are fewer observations than costs.
inline std::vector<cost> fitted_costs(const std::vector<observation>& all) {
  const std::size_t costs = all.empty() ? 0 : all.front().x.size();
  if (all.size() < std::max<std::size_t>(costs, 1)) {
    throw std::runtime_error("too little was measured to fit a cost model");
  }
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < costs; ++k) free.push_back(k);
  std::vector<cost> result(costs);
  while (!free.empty()) {
    const auto rows = static_cast<Eigen::Index>(all.size());
    const auto columns = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd a(rows, columns);
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const observation& one = all[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < columns; ++j) a(i, j) = one.x[free[static_cast<std::size_t>(j)]] / one.y;
    }
    // Bytes beside seconds: columns of one size, or rounding decides.
    for (Eigen::Index j = 0; j < columns; ++j) {
      largest[j] = a.col(j).norm();
      a.col(j) /= largest[j];
    }
    const Eigen::MatrixXd inverse = (a.transpose() * a).inverse();
    const Eigen::VectorXd c = inverse * (a.transpose() * Eigen::VectorXd::Ones(rows));
    Eigen::Index lowest = 0;
    if (c.minCoeff(&lowest) < 0.0) {
      result[free[static_cast<std::size_t>(lowest)]] = {};
      free.erase(free.begin() + lowest);
      continue;
    }
    const double left = (Eigen::VectorXd::Ones(rows) - a * c).squaredNorm();
    const double variance = rows > columns ? left / static_cast<double>(rows - columns)
                                           : std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index j = 0; j < columns; ++j) {
      result[free[static_cast<std::size_t>(j)]] = {c[j] / largest[j],
                                                   std::sqrt(variance * inverse(j, j)) / largest[j]};
    }
    break;
  }
  return result;
}

}  // namespace nysalt::bench
