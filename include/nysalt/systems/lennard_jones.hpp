// SPDX-License-Identifier: BSL-1.0
// Particles with the potential of Lennard-Jones: all pairs, and a cluster in three dimensions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/system.hpp"

namespace nysalt {

/// Atoms of unit mass in free space, each pair with the potential of Lennard and Jones in units of its depth
/// and range [verlet_1967]:
///   V = sum_{i<j} 4 (r_ij^-12 - r_ij^-6), least at r = 2^{1/6}.
/// Atom i has the coordinates q[Space i] .. q[Space i + Space - 1]. Space is 2 or 3; either number may be
/// Eigen::Dynamic, and the dimension is then. Close atoms move as fast as r^-7: there is no highest
/// frequency, and no bands are declared. A force costs a division and some 20 operations a pair, f'(q) v some
/// 20 more.
template <int Space = Eigen::Dynamic, int Atoms = Eigen::Dynamic>
class lennard_jones {
  static constexpr bool is_fixed = Space != Eigen::Dynamic && Atoms != Eigen::Dynamic;

 public:
  static_assert(Space == Eigen::Dynamic || Space == 2 || Space == 3, "nysalt: lennard_jones in 2D or 3D");
  static constexpr int dimension = is_fixed ? Space * Atoms : Eigen::Dynamic;

  lennard_jones()
    requires(is_fixed)
      : lennard_jones(Space, Atoms) {}

  /// Throws std::invalid_argument unless space is 2 or 3 and atoms >= 2 (and both fit the type).
  lennard_jones(Eigen::Index space, Eigen::Index atoms) : space_(space), atoms_(atoms) {
    if ((space != 2 && space != 3) || (Space != Eigen::Dynamic && space != Space)) {
      throw std::invalid_argument(sentence("lennard_jones: space dimension must be 2 or 3, got {}", space));
    }
    if (atoms < 2 || (Atoms != Eigen::Dynamic && atoms != Atoms)) {
      throw std::invalid_argument(
          sentence("lennard_jones: atoms must be >= 2, and those of the type, got {}", atoms));
    }
  }

  Eigen::Index space() const { return Space == Eigen::Dynamic ? space_ : Space; }  ///< 2 or 3 dimensions
  Eigen::Index atoms() const {
    return Atoms == Eigen::Dynamic ? atoms_ : Atoms;
  }  ///< number of atoms, 2 or more
  Eigen::Index size() const { return space() * atoms(); }

  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    each_pair(q, [&](Eigen::Index, Eigen::Index, const auto&, const T& inverse_square) {
      const T sixth = inverse_square * inverse_square * inverse_square;
      sum += sixth * sixth - sixth;
    });
    return sum * 4.0;
  }

  /// f = -grad V(q): (48 r^-14 - 24 r^-8) d on the first of a pair, d being the way to it from the second.
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (auto& entry : f) entry = T(0.0);
    each_pair(q, [&](Eigen::Index first, Eigen::Index second, const auto& d, const T& inverse_square) {
      const T sixth = inverse_square * inverse_square * inverse_square;
      const T push = (sixth * 48.0 - 24.0) * sixth * inverse_square;
      for (std::size_t axis = 0; axis < d.size(); ++axis) {
        const T along = push * d[axis];
        f[first + static_cast<Eigen::Index>(axis)] += along;
        f[second + static_cast<Eigen::Index>(axis)] -= along;
      }
    });
  }

  /// g = f'(q) v. With w = v_i - v_j, and P(r^2) the factor 48 r^-14 - 24 r^-8 of the force, it is
  /// P w + 2 P' (d w) d = (48 r^-14 - 24 r^-8) w - (672 r^-16 - 192 r^-10) (d w) d on the first of a pair.
  template <class T>
  void force_derivative(const vector<T, dimension>& q, const vector<T, dimension>& v,
                        vector<T, dimension>& g) const {
    for (auto& entry : g) entry = T(0.0);
    each_pair(q, [&](Eigen::Index first, Eigen::Index second, const auto& d, const T& inverse_square) {
      const T sixth = inverse_square * inverse_square * inverse_square;
      const T eighth = sixth * inverse_square;
      const T push = (sixth * 48.0 - 24.0) * eighth;
      std::remove_cvref_t<decltype(d)> w;
      T product(0.0);
      for (std::size_t axis = 0; axis < d.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        w[axis] = v[first + i] - v[second + i];
        product += d[axis] * w[axis];
      }
      const T pull = (sixth * 672.0 - 192.0) * eighth * inverse_square * product;
      for (std::size_t axis = 0; axis < d.size(); ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        const T along = push * w[axis] - pull * d[axis];
        g[first + i] += along;
        g[second + i] -= along;
      }
    });
  }

  std::string description() const { return sentence("lennard_jones(space={}, atoms={})", space(), atoms()); }
  /// The description without the number of atoms.
  std::string kind() const { return sentence("lennard_jones(space={})", space()); }

 private:
  /// Calls f(first, second, d, 1/r^2) for each pair of atoms: where the coordinates of each begin, and the
  /// way from the second to the first.
  template <class T>
  void each_pair(const vector<T, dimension>& q, auto&& f) const {
    if (space() == 2) {
      each_pair_in<2>(q, f);
    } else {
      each_pair_in<3>(q, f);
    }
  }
  template <int Axes, class T>
  void each_pair_in(const vector<T, dimension>& q, auto&& f) const {
    if constexpr (Space == Eigen::Dynamic || Space == Axes) {
      const Eigen::Index end = Axes * atoms();
      for (Eigen::Index first = 0; first < end; first += Axes) {
        for (Eigen::Index second = first + Axes; second < end; second += Axes) {
          std::array<T, Axes> d;
          T square(0.0);
          for (Eigen::Index axis = 0; axis < Axes; ++axis) {
            const T along = q[first + axis] - q[second + axis];
            d[static_cast<std::size_t>(axis)] = along;
            square += along * along;
          }
          f(first, second, d, T(1.0) / square);
        }
      }
    }
  }

  Eigen::Index space_;
  Eigen::Index atoms_;
};

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
  /// the stiffness of a pair: steps of this factor do not overshoot.
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

}  // namespace detail

}  // namespace nysalt
