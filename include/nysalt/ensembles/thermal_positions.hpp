// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/detail/fingerprint.hpp"
#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"

namespace nysalt {

/// Positions of a list, such as the draws of a sampler, with momenta of Maxwell's distribution, p_i ~ N(0,
/// m_i kT). Each start takes a position of the list at random, so that starts of one list may share it.
template <int N>
class thermal_positions {
 public:
  /// Positions for a system, whose masses scale the momenta. Throws std::invalid_argument if there is no
  /// position, one does not fit the system or is not finite, or kT is not positive and finite.
  template <SeparableSystem S>
    requires(S::dimension == N)
  thermal_positions(const S& system, std::vector<vector<double, N>> positions, double temperature) {
    if (!(temperature > 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(
          sentence("thermal_positions: kT must be positive and finite, got {}", temperature));
    }
    if (positions.empty())
      throw std::invalid_argument("thermal_positions: there must be a position, got none");
    for (std::size_t n = 0; n < positions.size(); ++n) {
      if (positions[n].size() == nysalt::size(system) && positions[n].allFinite()) continue;
      throw std::invalid_argument(
          sentence("thermal_positions: position {} must be {} finite numbers", n + 1, nysalt::size(system)));
    }
    for (Eigen::Index i = 0; i < nysalt::size(system); ++i) {
      double mass = 1.0;
      if constexpr (HasInverseMass<S>) mass = 1.0 / system.inverse_mass(i);
      deviations_.push_back(std::sqrt(mass * temperature));
    }
    detail::fingerprint sum;
    for (const auto& q : positions) sum.add_all(q);
    description_ = sentence("thermal_positions({} positions, temperature={}, fingerprint={})",
                            positions.size(), in_digits(temperature, 6), sum.text());
    positions_ = std::make_shared<const std::vector<vector<double, N>>>(std::move(positions));
  }

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    const auto size = static_cast<Eigen::Index>(deviations_.size());
    vector<double, Eigen::Dynamic> normals(size + 1);
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    const double uniform = 0.5 * std::erfc(-normals[size] / std::sqrt(2.0));
    const auto last = positions_->size() - 1;
    const auto number = static_cast<std::size_t>(uniform * static_cast<double>(positions_->size()));
    phase_point<double, N> x{(*positions_)[std::min(number, last)], vector<double, N>(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
      x.p[i] = normals[i] * deviations_[static_cast<std::size_t>(i)];
    }
    return x;
  }
  std::string description() const { return description_; }

 private:
  std::shared_ptr<const std::vector<vector<double, N>>> positions_;
  std::vector<double> deviations_;  // of the momenta
  std::string description_;
};

}  // namespace nysalt
