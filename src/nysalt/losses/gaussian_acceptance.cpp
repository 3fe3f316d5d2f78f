// SPDX-License-Identifier: BSL-1.0
// gaussian_acceptance, the mean energy error of proposals where forces are linear: no data are asked.
#include <cmath>
#include <map>
#include <stdexcept>

#include "data_loss.hpp"
#include "nysalt/derivatives/energy_on_oscillator.hpp"
#include "nysalt/detail/sentence.hpp"

namespace nysalt::detail {

namespace {

/// Number of oscillators by frequency: the modes; where none are declared, as many as there
/// are degrees of freedom, spread evenly over the bands.
std::map<double, double> spectrum_of(const model& system) {
  std::map<double, double> count_of;
  if (has_modes(system)) {
    for (const double omega : system.modes().frequencies) {
      if (omega > 0.0) count_of[omega] += 1.0;
    }
  } else if (has_frequency_bands(system)) {
    constexpr int points = 16;  // of a band, its midpoints
    const auto bands = system.frequency_bands();
    const double share = static_cast<double>(size(system)) / static_cast<double>(points * bands.size());
    for (const auto& [low, high] : bands) {
      for (int k = 0; k < points; ++k) {
        const double omega = low + (high - low) * (k + 0.5) / points;
        if (omega > 0.0 && std::isfinite(omega)) count_of[omega] += share;
      }
    }
  }
  if (count_of.empty()) {
    throw std::invalid_argument(
        sentence("the loss gaussian_acceptance: the system must declare frequencies, got {}; take the loss "
                 "acceptance, which asks states",
                 describe(system)));
  }
  return count_of;
}

/// The argument of acceptance_at(): half of rho at h omega for each oscillator.
objective of_spectrum(const model& system, const run_time_family& family, double step) {
  if (!family.symmetric || family.letters.rotates() || family.letters.is_processed()) {
    throw std::invalid_argument(
        sentence("gaussian_acceptance: the family must be symmetric, without rotations and "
                 "processors, got {}; "
                 "take the loss acceptance, or a family such as bab3",
                 family.name));
  }
  return [family, step, count_of = spectrum_of(system)](const Eigen::VectorXd& theta) {
    const Eigen::Index parameters = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(parameters), Eigen::MatrixXd::Zero(parameters, parameters)};
    const auto coefficients = family.coefficients(theta);
    const Eigen::MatrixXd jacobian = family.jacobian(theta);
    for (const auto& [omega, count] : count_of) {
      const energy_defect defect = energy_defect_on_oscillator(family.letters, coefficients, step * omega);
      const Eigen::VectorXd slope = jacobian.transpose() * defect.slopes;
      const double weight = 0.5 * count;
      sum.value += weight * defect.value * defect.value;
      sum.half_gradient += weight * defect.value * slope;
      sum.normal_matrix += weight * slope * slope.transpose();
    }
    return sum;
  };
}

}  // namespace

constinit const loss_kind gaussian_acceptance_loss{.name = "gaussian_acceptance",
                                                   .counts_steps = false,
                                                   .is_of_proposals = true,
                                                   .is_for_sampling = true,
                                                   .stages = stages_of_acceptance,
                                                   .over_data = of_energies,
                                                   .without_data = of_spectrum};

}  // namespace nysalt::detail
