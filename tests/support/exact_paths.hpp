// SPDX-License-Identifier: BSL-1.0
// Exact paths of the damped oscillator, and their noise: a reference for data and for strong errors.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "langevin_linear.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/reference.hpp"

namespace nysalt::test {

/// A PathReference. Over each part of the time, (q, p) and the noise of the bath come from their joint law.
class exact_paths {
 public:
  explicit exact_paths(const damped_oscillator& x) : oscillator_(x) {}

  template <class S, class T>
  void advance(const S&, phase_point<T, 1>& x, double t, const path_place& at,
               std::span<vector<T, 1>> xi) const {
    const auto parts = std::max<std::int64_t>(std::ssize(xi), 1);
    const auto part = oscillator_.exact_with_bath(t / static_cast<double>(parts));
    const square<3> L = cholesky(part.covariance);
    const auto& E = part.map;
    const double deviation = std::sqrt(part.covariance(2, 2));
    std::array<T, 3> z;
    for (std::int64_t k = 0; k < parts; ++k) {
      standard_normals<T>(at.seed, {.trajectory = at.trajectory, .step = at.step * parts + k}, z);
      const T q = x.q[0];
      const T p = x.p[0];
      x.q[0] = q * E(0, 0) + p * E(0, 1) + z[0] * L(0, 0);
      x.p[0] = q * E(1, 0) + p * E(1, 1) + z[0] * L(1, 0) + z[1] * L(1, 1);
      if (xi.empty() || deviation == 0.0) continue;
      const T noise = z[0] * L(2, 0) + z[1] * L(2, 1) + z[2] * L(2, 2);
      xi[static_cast<std::size_t>(k)][0] = noise * (1.0 / deviation);
    }
  }

  exact_paths finer() const { return *this; }
  std::string description() const { return "exact_paths()"; }

 private:
  damped_oscillator oscillator_;
};

}  // namespace nysalt::test
