// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/lennard_jones_cluster.hpp"

namespace nysalt {

/// A Lennard-Jones cluster at rest is struck: every start is cluster_at_rest with normal momenta of variance
/// kT, projected to where the whole neither moves nor turns. Each of the other directions has kinetic energy
/// kT/2 in the mean, and shares it with the potential later. From some kT = 0.3 on atoms leave.
template <int Space, int Atoms>
class lennard_jones_law {
  using state = vector<double, lennard_jones<Space, Atoms>::dimension>;

 public:
  /// Throws std::invalid_argument if the temperature, an energy, is negative or not finite.
  lennard_jones_law(const lennard_jones<Space, Atoms>& system, double temperature)
      : rest_(cluster_at_rest(system)), temperature_(temperature) {
    if (!(temperature >= 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(sentence(
          "lennard_jones_law: the temperature must be finite and not negative, got {}", temperature));
    }
    find_rigid_motions(system.space());
  }

  phase_point<double, lennard_jones<Space, Atoms>::dimension> operator()(std::uint64_t seed,
                                                                         std::uint64_t n) const {
    state p(rest_.size());
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, p);
    for (Eigen::Index i = 0; i < p.size(); ++i) p[i] *= std::sqrt(temperature_);
    for (const state& motion : rigid_motions_) remove(motion, p);
    return {rest_, p};
  }
  std::string description() const {
    return sentence("lennard_jones_law(temperature={})", in_digits(temperature_, 6));
  }

 private:
  static double product(const state& x, const state& y) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) sum += x[i] * y[i];
    return sum;
  }
  static void remove(const state& unit, state& from) {
    const double along = product(unit, from);
    for (Eigen::Index i = 0; i < from.size(); ++i) from[i] -= along * unit[i];
  }

  /// An orthonormal basis of shifts and turns, by Gram and Schmidt. Atoms on a line have a turn less.
  void find_rigid_motions(Eigen::Index space) {
    const auto add = [&](state motion) {
      for (const state& other : rigid_motions_) remove(other, motion);
      const double length = std::sqrt(product(motion, motion));
      constexpr double rounding = 1e-9;
      if (length > rounding) rigid_motions_.push_back(motion / length);
    };
    for (Eigen::Index axis = 0; axis < space; ++axis) {
      state shift = state::Zero(rest_.size());
      for (Eigen::Index i = axis; i < shift.size(); i += space) shift[i] = 1.0;
      add(shift);
    }
    for (Eigen::Index a = 0; a < space; ++a) {
      for (Eigen::Index b = a + 1; b < space; ++b) {
        state turn = state::Zero(rest_.size());
        for (Eigen::Index i = 0; i < turn.size(); i += space) {
          turn[i + a] = -rest_[i + b];
          turn[i + b] = rest_[i + a];
        }
        add(turn);
      }
    }
  }

  state rest_;
  double temperature_;
  std::vector<state> rigid_motions_;
};

}  // namespace nysalt
