// SPDX-License-Identifier: BSL-1.0
// A long chain, neither at rest nor chaotic, and what is done with it.
#pragma once

#include <cmath>
#include <span>

#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/fpu_chain.hpp"

namespace nysalt::bench {

using chain_point = phase_point<double, Eigen::Dynamic>;

inline constexpr double chain_omega = 50.0;
inline constexpr double chain_step = 0.01;

inline chain_point start_of_chain(Eigen::Index masses) {
  chain_point x{Eigen::VectorXd(masses), Eigen::VectorXd(masses)};
  for (Eigen::Index i = 0; i < masses; ++i) {
    x.q[i] = 0.1 * std::sin(0.7 * static_cast<double>(i / 2));
    x.p[i] = 0.1 * std::cos(0.3 * static_cast<double>(i));
  }
  return x;
}

/// As the program steps it: tile by tile.
inline model chain_model(Eigen::Index masses) { return fpu_chain<>(masses / 2, chain_omega); }

inline std::span<double> numbers(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
inline std::span<const double> numbers(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace nysalt::bench
