// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "nysalt/analysis/error_measure.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// A system with pairs() stiff springs and the energy of spring j, stiff_energy(x, j) >= 0.
template <class S, class T>
concept HasStiffEnergiesOver =
    System<S> && requires(const S& system, const phase_point<T, S::dimension>& x, Eigen::Index j) {
      { system.pairs() } -> std::convertible_to<Eigen::Index>;
      { system.stiff_energy(x, j) } -> std::same_as<T>;
    };
/// Stiff energies over double, see HasStiffEnergiesOver.
template <class S>
concept HasStiffEnergies = HasStiffEnergiesOver<S, double>;

/// Error of the exchange of energies I_j between the stiff springs, relative to their sum I: the mean over
/// trajectories and times of sum_j |I_j - I_j^ref|, over that of I^ref. The system is copied. There is no
/// such error where I^ref is 0 on all trajectories at all times.
template <HasStiffEnergies S>
error_measure exchange_measure(const S& system) {
  constexpr int N = S::dimension;
  const auto read = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    const auto& same = detail::of_dimension<N>(x);
    for (std::size_t j = 0; j < result.size(); ++j) {
      const auto energy = [&](const auto& y) { return system.stiff_energy(y, static_cast<Eigen::Index>(j)); };
      if constexpr (lanes_of<S> == 1) {  // packs are not even tried
        result[j] = value_in_lanes<T>(energy, same);
      } else if constexpr (HasStiffEnergiesOver<S, T>) {
        result[j] = energy(same);
      } else {
        result[j] = value_in_lanes<T>(energy, same);
      }
    }
  };
  const auto whole = []<class T>(std::span<const T> expected) {
    T total(0.0);
    for (const T& energy : expected) total += energy;
    return total;
  };
  const auto error = []<class T>(std::span<const T> seen, std::span<const T> expected) {
    using std::abs;
    T differences(0.0);
    for (std::size_t j = 0; j < expected.size(); ++j) differences += abs(seen[j] - expected[j]);
    return differences;
  };
  return {.name = "exchange",
          .width = static_cast<std::size_t>(system.pairs()),
          .read = read,
          .error = error,
          .how = averaging::mean,
          .no_scale =
              "the exchange error: the stiff energy on the reference, to which the error is relative, must "
              "not be 0; take starts at which the stiff springs move, or measure states",
          .relative_to = whole,
          .dimension = size(system)};
}

}  // namespace nysalt
