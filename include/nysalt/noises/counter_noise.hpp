// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstdint>

#include "nysalt/noise.hpp"
#include "nysalt/noises/counter_based.hpp"

namespace nysalt {

/// Fresh noise: a pure function of seed, trajectory, step and letter. Two runs with one seed see the same
/// numbers at the same places, for any lanes, threads and order.
class counter_noise {
 public:
  static constexpr bool is_memoryless = true;

  /// `purpose` keeps it apart from all other noise of the same seed.
  explicit counter_noise(std::uint64_t seed, noise_purpose purpose = noise_purpose::bath)
      : seed_(seed), purpose_(purpose) {}

  /// The standard normal numbers of a place. Throws std::invalid_argument if the place is beyond what can be
  /// counted (2^48 trajectories and steps).
  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    draw(purpose_, at, xi);
  }
  /// Further numbers of a place, independent of the first. Throws as normals does.
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    const bool is_burn_in = purpose_ == noise_purpose::burn_in;
    draw(is_burn_in ? noise_purpose::burn_in_halves : noise_purpose::bath_halves, at, zeta);
  }

 private:
  template <class T, int N>
  void draw(noise_purpose purpose, const noise_place& at, vector<T, N>& out) const {
    const auto slots = slots_for(static_cast<std::uint64_t>(out.size()));
    const noise_counter counter{.trajectory = at.trajectory,
                                .step = at.step,
                                .slot = slots * static_cast<std::uint64_t>(at.flow),
                                .purpose = purpose};
    standard_normals(seed_, counter, out);
  }

  std::uint64_t seed_;
  noise_purpose purpose_;
};

}  // namespace nysalt
