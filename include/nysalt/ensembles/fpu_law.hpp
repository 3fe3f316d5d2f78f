// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/fpu_chain.hpp"

namespace nysalt {

/// Initial states of the soft springs.
struct soft_motion {
  double displacement = 1.0;  ///< x_0 of every pair
  double velocity = 1.0;      ///< y_0 of every pair
};

/// States of the FPU chain [li_lu_tao_ye_2023, equation (5.5)]: x_0 and y_0 as given, and x_1 = 1/omega +
/// zeta, y_1 = 1 + eta, with zeta and eta normal of standard deviation spread/omega. The paper's spread, x_0
/// and y_0 are 1: nearly harmonic states. Those of soft_dominated are not.
template <int Pairs>
class fpu_law {
 public:
  /// Throws std::invalid_argument if the spread is negative, or it or the soft motion not finite.
  explicit fpu_law(const fpu_chain<Pairs>& chain, double spread = 1.0, const soft_motion& soft = {})
      : pairs_(chain.pairs()), omega_(chain.omega()), spread_(spread), soft_(soft) {
    const bool finite =
        std::isfinite(spread) && std::isfinite(soft.displacement) && std::isfinite(soft.velocity);
    if (spread >= 0.0 && finite) return;
    throw std::invalid_argument(
        sentence("fpu_law: the spread must be finite and not negative, and the soft motion finite, got {}, "
                 "{} and {}",
                 spread, soft.displacement, soft.velocity));
  }

  /// An initial distribution with the soft energy omega^2, half in motion (m y_0^2/2) and half in the two
  /// springs at the ends (x_0^4/2 together; those between start at rest).
  static fpu_law soft_dominated(const fpu_chain<Pairs>& chain) {
    const auto m = static_cast<double>(chain.pairs());
    return fpu_law(chain, 1.0, {std::sqrt(chain.omega()), chain.omega() / std::sqrt(m)});
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
      start.q[2 * i] = (soft_.displacement - x1) * half;
      start.q[2 * i + 1] = (soft_.displacement + x1) * half;
      start.p[2 * i] = (soft_.velocity - y1) * half;
      start.p[2 * i + 1] = (soft_.velocity + y1) * half;
    }
    return start;
  }
  std::string description() const {
    std::string text = sentence("fpu_law(omega={}", omega_);
    if (spread_ != 1.0) text += sentence(", spread={}", spread_);
    if (soft_.displacement != 1.0 || soft_.velocity != 1.0) {
      text += sentence(", x_0={}, y_0={}", soft_.displacement, soft_.velocity);
    }
    return text + ")";
  }

 private:
  Eigen::Index pairs_;
  double omega_;
  double spread_;
  soft_motion soft_;
};

}  // namespace nysalt
