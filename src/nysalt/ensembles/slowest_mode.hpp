// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>

#include "nysalt/model.hpp"

namespace nysalt {

/// w with w . q = omega x of the mode that is slowest, so that (w . q)^2 is kT in the mean: what all other
/// means would hide in a system of many modes. Empty where the system declares no modes, or some without a
/// frequency: then the slowest motion is none of them. Cost: that of modes().
inline Eigen::VectorXd slowest_mode(const model& system) {
  Eigen::VectorXd weights;
  if (!has_modes(system)) return weights;
  const normal_modes modes = system.modes();
  Eigen::Index slowest = 0;
  const double omega = modes.frequencies.minCoeff(&slowest);
  if (!(omega > 0.0)) return weights;
  weights = omega * modes.basis.col(slowest);
  if (system.has_unit_mass()) return weights;
  for (Eigen::Index i = 0; i < weights.size(); ++i) weights[i] /= std::sqrt(system.inverse_mass(i));
  return weights;
}

}  // namespace nysalt
