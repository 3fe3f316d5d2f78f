// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "nysalt/detail/sentence.hpp"
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

}  // namespace nysalt
