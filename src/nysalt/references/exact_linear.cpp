// SPDX-License-Identifier: BSL-1.0
#include "nysalt/references/exact_linear.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace nysalt {

void exact_linear::require_orthonormal(const normal_modes& modes, Eigen::Index n) const {
  const bool fit = modes.basis.rows() == n && modes.basis.cols() == n && modes.frequencies.size() == n;
  // n products of numbers below 1, and as much again for how the basis was found.
  if (fit &&
      (modes.basis.transpose() * modes.basis - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() <=
          32.0 * static_cast<double>(n) * eps) {
    return;
  }
  throw std::invalid_argument(fmt::format(
      "exact_linear: modes() of {} must give {} orthonormal columns with a frequency each", system_, n));
}

void exact_linear::refuse_force(Eigen::Index i, double force, double expected, double length) const {
  throw std::invalid_argument(
      fmt::format("exact_linear: the force of {} must be linear as modes() says, got coordinate {} off by "
                  "{:.2e} of {:.2e} at a state of size {}; take fine_steps or odeint_reference",
                  system_, i + 1, force - expected, expected, length));
}

}  // namespace nysalt
