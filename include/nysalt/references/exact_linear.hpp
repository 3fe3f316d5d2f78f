// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <string>

#include "nysalt/system.hpp"

namespace nysalt {

/// The exact flow of a linear system, mode by mode: x(t) = cos(w t) x + sin(w t)/w y,
/// y(t) = -w sin(w t) x + cos(w t) y with x = U^T M^{1/2} q, y = U^T M^{-1/2} p. Its error is rounding.
/// The system must be linear (its potential the quadratic form that modes() describes).
class exact_linear {
 public:
  template <System S>
    requires HasModes<S>
  explicit exact_linear(const S& system)
      : modes_(system.modes()), root_mass_(Eigen::VectorXd::Ones(size(system))) {
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < size(system); ++i) root_mass_[i] = 1.0 / std::sqrt(system.inverse_mass(i));
    }
  }

  template <System S>
  void advance(const S&, phase_point<double, S::dimension>& point, double t) const {
    Eigen::VectorXd x = modes_.basis.transpose() * root_mass_.cwiseProduct(point.q);
    Eigen::VectorXd y = modes_.basis.transpose() * point.p.cwiseQuotient(root_mass_);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double w = modes_.frequencies[k];
      const double c = std::cos(w * t);
      const double s = std::sin(w * t);
      const double x_new = c * x[k] + (w == 0.0 ? t : s / w) * y[k];
      y[k] = -w * s * x[k] + c * y[k];
      x[k] = x_new;
    }
    point.q = (modes_.basis * x).cwiseQuotient(root_mass_);
    point.p = (modes_.basis * y).cwiseProduct(root_mass_);
  }

  exact_linear finer() const { return *this; }
  std::string description() const { return "the exact linear flow"; }

 private:
  normal_modes modes_;
  Eigen::VectorXd root_mass_;
};

}  // namespace nysalt
