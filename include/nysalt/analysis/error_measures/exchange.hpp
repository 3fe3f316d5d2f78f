// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Has pairs() stiff springs, the energy of spring j being stiff_energy(x, j) >= 0.
template <class S>
concept HasStiffEnergies = System<S> &&
    requires(const S& system, const phase_point<double, S::dimension>& x, Eigen::Index j) {
  { system.pairs() } -> std::convertible_to<Eigen::Index>;
  { system.stiff_energy(x, j) } -> std::same_as<double>;
};

/// How wrongly the stiff springs exchange their energies I_j, relative to their sum I: the mean over
/// trajectories and times of sum_j |I_j - I_j^ref| / I^ref. The system is copied. Throws
/// std::invalid_argument, when used, where I^ref is 0.
template <HasStiffEnergies S>
error_measure<S::dimension> exchange_measure(const S& system) {
  using numbers = std::span<const double>;
  const auto read = [system](const auto& x, std::span<double> result) {
    for (std::size_t j = 0; j < result.size(); ++j) {
      result[j] = system.stiff_energy(x, static_cast<Eigen::Index>(j));
    }
  };
  const auto error = [](numbers seen, numbers expected, numbers) {
    double differences = 0.0;
    double total = 0.0;
    for (std::size_t j = 0; j < expected.size(); ++j) {
      differences += std::abs(seen[j] - expected[j]);
      total += expected[j];
    }
    if (total == 0.0) {
      throw std::invalid_argument(
          "the exchange error is relative to the stiff energy on the reference, which is 0 somewhere; take "
          "starts at which the stiff springs move, or measure states");
    }
    return differences / total;
  };
  return {"exchange", static_cast<std::size_t>(system.pairs()), read, error, averaging::mean};
}

}  // namespace nysalt
