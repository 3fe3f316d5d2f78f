// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
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
    modes_ = modal_coordinates::of(system);
    if (!(temperature > 0.0) || !std::isfinite(temperature) ||
        !(std::ranges::min(modes_->frequencies()) > 0.0)) {
      throw std::invalid_argument(
          sentence("gibbs_of_modes: temperature and the frequency of each mode must be above 0, got {} at "
                   "temperature {}",
                   describe(system), temperature));
    }
  }

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    vector<double, N> x(modes_->size());
    vector<double, N> y(modes_->size());
    noise_counter at = {.trajectory = n, .purpose = noise_purpose::initial_state};
    standard_normals(seed, at, x);
    at.slot += slots_for(static_cast<std::uint64_t>(x.size()));
    standard_normals(seed, at, y);
    const double deviation = std::sqrt(temperature_);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      x[k] *= deviation / modes_->frequencies()[static_cast<std::size_t>(k)];
      y[k] *= deviation;
    }
    phase_point<double, N> state{vector<double, N>(x.size()), vector<double, N>(x.size())};
    modes_->from_modes(x, y, state.q, state.p);
    return state;
  }
  std::string description() const {
    return sentence("gibbs_of_modes(temperature={})", in_digits(temperature_, 6));
  }

 private:
  double temperature_;
  std::shared_ptr<const modal_coordinates> modes_;
};

}  // namespace nysalt
