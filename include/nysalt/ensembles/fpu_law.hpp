// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/fpu_chain.hpp"

namespace nysalt {

/// Nearly harmonic states of the FPU chain [li_lu_tao_ye_2023, equation (5.5)]: x_0 = y_0 = 1 and
/// x_1 = 1/omega + zeta, y_1 = 1 + eta, with zeta and eta normal of standard deviation spread/omega; the
/// paper's spread is 1.
template <int Pairs>
class fpu_law {
 public:
  /// Throws std::invalid_argument if the spread is negative or not finite.
  explicit fpu_law(const fpu_chain<Pairs>& chain, double spread = 1.0)
      : pairs_(chain.pairs()), omega_(chain.omega()), spread_(spread) {
    if (spread >= 0.0 && std::isfinite(spread)) return;
    throw std::invalid_argument(
        fmt::format("fpu_law: the spread must be finite and not negative, got {}", spread));
  }

  phase_point<double, fpu_chain<Pairs>::dimension> operator()(std::uint64_t seed, std::uint64_t n) const {
    using state = vector<double, fpu_chain<Pairs>::dimension>;
    phase_point<double, fpu_chain<Pairs>::dimension> start{state(2 * pairs_), state(2 * pairs_)};
    state normals(2 * pairs_);
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    const double half = std::sqrt(0.5);
    for (Eigen::Index i = 0; i < pairs_; ++i) {
      const double x1 = (1.0 + spread_ * normals[2 * i]) / omega_;
      const double y1 = 1.0 + spread_ * normals[2 * i + 1] / omega_;
      start.q[2 * i] = (1.0 - x1) * half;
      start.q[2 * i + 1] = (1.0 + x1) * half;
      start.p[2 * i] = (1.0 - y1) * half;
      start.p[2 * i + 1] = (1.0 + y1) * half;
    }
    return start;
  }
  std::string description() const {
    if (spread_ == 1.0) return fmt::format("fpu_law(omega={})", omega_);
    return fmt::format("fpu_law(omega={}, spread={})", omega_, spread_);
  }

 private:
  Eigen::Index pairs_;
  double omega_;
  double spread_;
};

}  // namespace nysalt
