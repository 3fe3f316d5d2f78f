// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>

#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

/// Fresh noise of some step, for that step halved k times: the same path, seen more finely. With
/// a = e^{-gamma h} of the half step h, and zeta further numbers, the halves of xi are
///   xi_1 = (a xi + zeta)/sqrt(1 + a^2),  xi_2 = (xi - a zeta)/sqrt(1 + a^2).
/// Of words with one letter O.
class finer_noise {
 public:
  static constexpr bool is_memoryless = false;

  /// Noise of that seed for steps that were halved so often. `damping` is gamma times the step that is not
  /// halved.
  finer_noise(std::uint64_t seed, double damping, int halvings)
      : whole_(seed), halves_(seed, noise_purpose::finer_path), damping_(damping), halvings_(halvings) {}

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    halved(halvings_, at, xi);
  }

 private:
  template <class T, int N>
  void halved(int times, const noise_place& at, vector<T, N>& xi) const {
    if (times == 0) return whole_.normals(at, xi);
    const noise_place parent{at.trajectory, at.step / 2, 0};
    auto zeta = xi;
    halved(times - 1, parent, xi);
    halves_.normals(noise_place{at.trajectory, at.step / 2, times}, zeta);
    const double a = std::exp(-std::ldexp(damping_, -times));
    const double scale = 1.0 / std::sqrt(1.0 + a * a);
    const bool is_first = at.step % 2 == 0;
    const double of_xi = (is_first ? a : 1.0) * scale;
    const double of_zeta = (is_first ? 1.0 : -a) * scale;
    for (Eigen::Index i = 0; i < xi.size(); ++i) xi[i] = xi[i] * of_xi + zeta[i] * of_zeta;
  }

  counter_noise whole_;
  counter_noise halves_;
  double damping_;
  int halvings_;
};

}  // namespace nysalt
