// SPDX-License-Identifier: BSL-1.0
// How stiff, and how unstable, the forces on a system are along its motion.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <ranges>
#include <stdexcept>

#include "nysalt/derivatives/lanczos.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

/// Eigenvalues of -M^{-1/2} f'(q) M^{-1/2} over some states: squares of frequencies, or, where negative, of
/// rates at which neighbours part.
struct stiffness_range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  std::int64_t states = 0;
  std::int64_t evaluations = 0;  // of f'(q) v

  double highest_frequency() const { return std::sqrt(std::max(0.0, highest)); }
};

/// g = f'(q) v of a force f(q, result) that is known over dual numbers.
template <int N>
auto derivative_along(auto f) {
  return [f](const vector<double, N>& q, const vector<double, N>& v, vector<double, N>& g) {
    using D = dual<double, 1>;
    vector<D, N> at(q.size());
    vector<D, N> result(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      at[i] = D(q[i]);
      at[i].derivative[0] = v[i];
    }
    f(at, result);
    for (Eigen::Index i = 0; i < q.size(); ++i) g[i] = result[i].derivative[0];
  };
}

/// The same for the force of a system, a black box included.
template <SeparableSystem S>
auto derivative_of_force(const S& system) {
  return derivative_along<S::dimension>(
      [&system](const auto& q, auto& f) { force<dual<double, 1>>(system, q, f); });
}

/// Over all states (a range of phase_point<double, N>), where directional(q, v, g) gives g = f'(q) v of the
/// system's force or of a part of it. Both ends are known to 1 % and mostly rounded outwards, see
/// ends_of_spectrum(); who needs a bound adds a percent. The same states give the same bits. Cost: some 8 to
/// 40 directional derivatives a state. Throws std::invalid_argument if there are no states, or one where the
/// force has no finite derivative.
template <NystromSystem S>
stiffness_range stiffness_along(const S& system, const std::ranges::range auto& states, auto&& directional) {
  const Eigen::Index n = size(system);
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);  // M^{-1/2}
  if constexpr (HasInverseMass<S>) {
    for (Eigen::Index i = 0; i < n; ++i) root[i] = std::sqrt(system.inverse_mass(i));
  }
  // Every start has a part of chance, the same for all, so that no end can hide from it; and of the ends of
  // the state before, which are near.
  std::mt19937_64 bits{1};
  Eigen::VectorXd chance(n);
  for (double& x : chance) x = static_cast<double>(bits() >> 11U) * 0x1p-53 - 0.5;
  chance.normalize();
  Eigen::VectorXd start = chance;

  stiffness_range found;
  auto v = make_vector<double>(system);
  auto g = make_vector<double>(system);
  for (const auto& state : states) {
    const auto ends = ends_of_spectrum(
        [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
          v = root.cwiseProduct(x);
          directional(state.q, v, g);
          return -root.cwiseProduct(g);
        },
        start);
    if (!std::isfinite(ends.lowest) || !std::isfinite(ends.highest)) {
      throw std::invalid_argument(fmt::format(
          "stiffness_along: the force has no finite derivative at state {}; leave it out", found.states));
    }
    found.lowest = std::min(found.lowest, ends.lowest);
    found.highest = std::max(found.highest, ends.highest);
    found.evaluations += ends.products;
    ++found.states;
    start = chance + ends.lowest_direction + ends.highest_direction;
  }
  if (found.states == 0) throw std::invalid_argument("stiffness_along: there are no states to look at");
  return found;
}

template <NystromSystem S>
stiffness_range stiffness_along(const S& system, const std::ranges::range auto& states) {
  return stiffness_along(system, states, derivative_of_force(system));
}

}  // namespace nysalt
