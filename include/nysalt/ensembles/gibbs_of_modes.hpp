// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/references/exact_linear.hpp"

namespace nysalt {

/// Independent states from exp(-H/kT) of a linear system, mode by mode: omega_k x_k and y_k are normal with
/// variance kT. Exact, and nothing has to be burned in.
template <int N>
class gibbs_of_modes {
 public:
  /// Throws std::invalid_argument unless the force is the linear one of the modes, all of these have a
  /// frequency, and the temperature is finite and positive.
  template <HasModes S>
    requires(S::dimension == N)
  gibbs_of_modes(const S& system, double temperature) : temperature_(temperature) {
    const exact_linear linear(system);  // refuses any other
    const normal_modes modes = system.modes();
    if (!(temperature > 0.0) || !std::isfinite(temperature) || !(modes.frequencies.minCoeff() > 0.0)) {
      throw std::invalid_argument(
          sentence("gibbs_of_modes: {} at temperature {} has no Gibbs law that is normal: it needs a "
                   "temperature above "
                   "0, and a frequency above 0 of each mode",
                   describe(system), temperature));
    }
    const double deviation = std::sqrt(temperature);
    to_q_ = modes.basis * (deviation * modes.frequencies.cwiseInverse()).asDiagonal();
    to_p_ = modes.basis * deviation;
    if constexpr (HasInverseMass<S>) {
      for (Eigen::Index i = 0; i < to_q_.rows(); ++i) {
        const double root = std::sqrt(system.inverse_mass(i));
        to_q_.row(i) *= root;
        to_p_.row(i) /= root;
      }
    }
  }

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    vector<double, N> x(to_q_.rows());
    vector<double, N> y(to_q_.rows());
    noise_counter at = {.trajectory = n, .purpose = noise_purpose::initial_state};
    standard_normals(seed, at, x);
    at.slot += slots_for(static_cast<std::uint64_t>(x.size()));
    standard_normals(seed, at, y);
    return {to_q_ * x, to_p_ * y};
  }
  std::string description() const {
    return sentence("gibbs_of_modes(temperature={})", in_digits(temperature_, 6));
  }

 private:
  double temperature_;
  Eigen::MatrixXd to_q_;
  Eigen::MatrixXd to_p_;
};

}  // namespace nysalt
