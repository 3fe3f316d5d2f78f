// SPDX-License-Identifier: BSL-1.0
// Products with f'(q) at one state after the other, of any force.
#pragma once

#include <ranges>
#include <vector>

#include "nysalt/derivatives/differences.hpp"
#include "nysalt/force.hpp"

namespace nysalt {

/// f'(q) v of a field at states of a motion. Differences of a black box go a part of how far the states lie
/// apart. Refers to the system.
template <field F, System S>
  requires ForceDerivativeOver<S, double, F>
class force_jacobian {
 public:
  /// The Jacobian of the force on the motion that passes through these states (a range of phase_point<double,
  /// N>).
  force_jacobian(const S& system, const std::ranges::range auto& states)
      : system_(&system),
        room_(size(system)),
        q_(vector<double, S::dimension>::Zero(size(system))),
        v_(q_),
        f_(q_),
        g_(q_) {
    if (differs()) {
      std::vector<Eigen::VectorXd> points;
      for (const auto& state : states) points.push_back(state.q);
      if (!points.empty()) lengths_ = detail::lengths_of(points);
    }
  }

  /// Moves to the state where the next products are taken. Cost: a force, of a black box.
  void move_to(const vector<double, S::dimension>& q) {
    q_ = q;
    if constexpr (may_differ) {
      if (differs()) system_->force(q_, f_);
    }
  }

  /// f'(q) v. Cost: one directional derivative.
  const vector<double, S::dimension>& times(const vector<double, S::dimension>& v) {
    if constexpr (may_differ) {
      if (differs()) {
        const double displacements = v.cwiseQuotient(lengths_).cwiseAbs().maxCoeff();
        v_ = v / displacements;
        directional_derivative(*system_, q_, v_, f_, g_);
        g_ *= displacements;
        return g_;
      }
    }
    force_along<F, double>(*system_, q_, v, g_, room_);
    return g_;
  }

 private:
  static constexpr bool may_differ = F == field::whole && (ErasedSystem<S> || derivative_calls<S> == 2);
  bool differs() const { return may_differ && calls_of_derivative(*system_) == 2; }

  const S* system_;
  lifted_room<double, S::dimension> room_;
  vector<double, S::dimension> q_;
  vector<double, S::dimension> v_;
  vector<double, S::dimension> f_;
  vector<double, S::dimension> g_;
  Eigen::VectorXd lengths_;
};

}  // namespace nysalt
