// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "nysalt/systems/lennard_jones.hpp"

namespace nysalt {

namespace detail {

/// Atoms at rest, one added at a time, where it is drawn most.
class growing_cluster {
 public:
  /// One, two, ... atoms at the corners of a triangle, in space of a tetrahedron, of side 2^{1/6}.
  growing_cluster(Eigen::Index space, Eigen::Index atoms) : space_(space), q_(space * atoms) {
    const double side = std::pow(2.0, 1.0 / 6.0);
    const double height = std::sqrt(0.75);
    const std::array<std::array<double, 3>, 4> corners{
        {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.5, height, 0.0}, {0.5, height / 3.0, std::sqrt(2.0 / 3.0)}}};
    for (Eigen::Index i = 0; i < q_.size(); ++i) {
      q_[i] = side * corners[static_cast<std::size_t>(i / space)][static_cast<std::size_t>(i % space)];
    }
  }

  Eigen::Index atoms() const { return q_.size() / space_; }
  const Eigen::VectorXd& coordinates() const { return q_; }

  /// Onto a side of a triangle or a face of a tetrahedron of atoms that touch: its last corner, mirrored.
  void add_atom() {
    least_energy_ = std::numeric_limits<double>::infinity();
    corners_.clear();
    try_simplices(0);
    Eigen::VectorXd grown(q_.size() + space_);
    grown << q_, best_place_;
    q_ = grown;
  }

  /// Goes down the force until none is larger than `rest`. An atom feels a stiffness of a few times V'' = 57,
  /// that of a pair: steps of this factor do not overshoot.
  void relax(double rest) {
    constexpr double factor = 1e-3;
    constexpr int most_steps = 100'000;
    const lennard_jones<> system(space_, atoms());
    Eigen::VectorXd f(q_.size());
    for (int n = 0; n < most_steps; ++n) {
      system.force(q_, f);
      double largest = 0.0;
      for (const double entry : f) largest = std::max(largest, std::abs(entry));
      if (largest <= rest) return;
      for (Eigen::Index i = 0; i < q_.size(); ++i) q_[i] += factor * f[i];
    }
  }

  /// The centre of mass becomes the origin.
  void centre() {
    for (Eigen::Index axis = 0; axis < space_; ++axis) {
      double sum = 0.0;
      for (Eigen::Index i = axis; i < q_.size(); i += space_) sum += q_[i];
      for (Eigen::Index i = axis; i < q_.size(); i += space_) q_[i] -= sum / static_cast<double>(atoms());
    }
  }

 private:
  double squared_distance(const Eigen::VectorXd& place, Eigen::Index atom) const {
    double sum = 0.0;
    for (Eigen::Index axis = 0; axis < space_; ++axis) {
      const double d = place[axis] - q_[space_ * atom + axis];
      sum += d * d;
    }
    return sum;
  }

  void try_simplices(Eigen::Index first) {
    if (static_cast<Eigen::Index>(corners_.size()) == space_ + 1) return try_faces();
    constexpr double touching = 1.6;  // squared: between 2^{1/3} = 1.26 and twice that, of the next but one
    for (Eigen::Index i = first; i < atoms(); ++i) {
      const Eigen::VectorXd mine = q_.segment(space_ * i, space_);
      const auto touches = [&](Eigen::Index j) { return squared_distance(mine, j) < touching; };
      if (!std::all_of(corners_.begin(), corners_.end(), touches)) continue;
      corners_.push_back(i);
      try_simplices(i + 1);
      corners_.pop_back();
    }
  }

  void try_faces() {
    for (const Eigen::Index mirrored : corners_) {
      Eigen::VectorXd place(space_);
      for (Eigen::Index axis = 0; axis < space_; ++axis) {
        double face = 0.0;
        for (const Eigen::Index i : corners_) face += i == mirrored ? 0.0 : q_[space_ * i + axis];
        place[axis] = 2.0 * face / static_cast<double>(space_) - q_[space_ * mirrored + axis];
      }
      double energy = 0.0;
      for (Eigen::Index i = 0; i < atoms(); ++i) {
        const double inverse_square = 1.0 / squared_distance(place, i);
        const double sixth = inverse_square * inverse_square * inverse_square;
        energy += 4.0 * (sixth * sixth - sixth);
      }
      constexpr double rounding =
          1e-6;  // of places that are equal by symmetry the first is taken, everywhere
      if (energy > least_energy_ - rounding) continue;
      least_energy_ = energy;
      best_place_ = place;
    }
  }

  Eigen::Index space_;
  Eigen::VectorXd q_;
  std::vector<Eigen::Index> corners_;
  double least_energy_ = 0.0;
  Eigen::VectorXd best_place_;
};

}  // namespace detail

/// Coordinates of a compact cluster at rest, its centre of mass at the origin: a local minimum of V, grown
/// one atom at a time from a triangle or tetrahedron. Seven atoms in the plane make the centred hexagon,
/// thirteen in space the icosahedron. It need not be the lowest minimum: six in space make no octahedron.
/// Cost: a second for some 50 atoms.
template <int Space, int Atoms>
vector<double, lennard_jones<Space, Atoms>::dimension> cluster_at_rest(
    const lennard_jones<Space, Atoms>& system) {
  detail::growing_cluster cluster(system.space(), std::min(system.atoms(), system.space() + 1));
  while (cluster.atoms() < system.atoms()) {
    cluster.add_atom();
    cluster.relax(1e-6);
  }
  cluster.relax(1e-12);
  cluster.centre();
  return cluster.coordinates();
}

}  // namespace nysalt
