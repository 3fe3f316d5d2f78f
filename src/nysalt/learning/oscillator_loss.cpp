// SPDX-License-Identifier: BSL-1.0
#include "nysalt/detail/oscillator_loss.hpp"

#include <cmath>
#include <numbers>

#include "nysalt/families/phase_fitting.hpp"

namespace nysalt::detail {

namespace {

/// What defects of z^2 are multiplied with to be those of the matrix itself, its four entries counted. Of a
/// kernel only the phase counts, which is the first: a processor does the rest.
Eigen::VectorXd weights_of_defects(Eigen::Index count, double z, bool is_kernel) {
  const double root = std::numbers::sqrt2;  // the half trace is of two entries, and so does the difference
  Eigen::VectorXd weights(4);
  weights << root * std::pow(z, 4), std::pow(z, 3), std::pow(z, 3), root * z * z;
  if (is_kernel) weights.tail(3).setZero();
  return weights.head(count);
}

}  // namespace

objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step) {
  constexpr int points_of_band = 4;
  std::vector<double> angles;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < points_of_band; ++k) {
      const double z = step * (low + (high - low) * (k + 1.0) / points_of_band);
      if (z > 0.0 && std::isfinite(z)) angles.push_back(z);
    }
  }
  if (angles.empty() || family.letters.rotates()) return {};
  return [family, angles](const Eigen::VectorXd& theta) {
    const Eigen::Index count = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    const auto coefficients = family.coefficients(theta);
    for (const double z : angles) {
      Eigen::VectorXd r = defect_of_rotation(family.letters, coefficients, family.symmetric, z * z);
      const Eigen::VectorXd weights = weights_of_defects(r.size(), z, family.letters.is_processed());
      r = r.cwiseProduct(weights);
      const Eigen::MatrixXd slopes = weights.asDiagonal() * jacobian_of_defect(family, theta, z * z);
      sum.value += r.squaredNorm();
      sum.half_gradient += slopes.transpose() * r;
      sum.normal_matrix += slopes.transpose() * slopes;
    }
    const double share = 1.0 / static_cast<double>(angles.size());
    return squares{share * sum.value, share * sum.half_gradient, share * sum.normal_matrix};
  };
}

}  // namespace nysalt::detail
