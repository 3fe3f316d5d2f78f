// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <string>

#include "nysalt/phase_point.hpp"

namespace nysalt {

namespace detail {
class neighbour_list;
}

/// Options of a lennard_jones_liquid.
struct lennard_jones_liquid_options {
  double cutoff = 2.5;  ///< r_c, in units of the range
  /// How many derivatives of a pair's potential are continuous at the cut-off: 0 to 3.
  int smoothness = 0;
  double skin = 0.3;  ///< of the neighbour list: how much farther than the cut-off it reaches
};

/// A liquid of N atoms of unit mass in a periodic cube of side L = (N/density)^{1/3}, each pair within the
/// cut-off r_c with the potential of Lennard and Jones in units of its depth and range [verlet_1967], less
/// its Taylor polynomial of degree `smoothness` in r^2 around r_c^2:
///   V = sum_{i<j, r_ij < r_c} u(r_ij^2) - T(r_ij^2),   u(r^2) = 4 (r^-12 - r^-6).
/// Smoothness 0 shifts the energy only, as others do by default: the force jumps at r_c by 0.039 for r_c =
/// 2.5, so that the energy errors of all methods end at a floor that no order lowers. Smoothness 1 is the
/// potential of Stoddard and Ford [stoddard_ford_1973], whose force is continuous; a method of order 4 wants
/// 2 or 3. The pair's well becomes shallower: by 0.02, 0.06, 0.12 and 0.20 at r = 2^{1/6}.
///
/// Atom i has the coordinates q[3 i] .. q[3 i + 2], which may leave the box: what counts is the nearest image
/// of each pair. Positions are rounded to 2^-52 of the side.
///
/// The bits of force, f'(q) v, energy and virial are functions of q: they depend neither on when the
/// neighbour list was made, nor on the skin or the number of threads, as sums do not depend on the order of
/// their summands. A component is the exact sum of the pairs' to 2^-61 for each pair, rounded once. Atoms
/// nearer than 1/4 make it not a number, as do positions 2^16 sides or more from the origin.
///
/// Cost: some 78 neighbours an atom at the density 0.8442, each 5 to 6 cycles with vectors of four; the list
/// is made again when an atom has moved half the skin, which costs some five forces. Nothing is allocated but
/// then. An object keeps the list from call to call, and each copy makes one of its own: an object serves one
/// trajectory at a time, and may be called by one thread at a time.
class lennard_jones_liquid {
 public:
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr int lanes = 1;  ///< the pairs of an atom fill the processor's vectors

  /// Throws std::invalid_argument unless 2 <= atoms < 2^31, density, cut-off and skin are positive and
  /// finite, the cut-off is at least 1, smoothness is from 0 to 3, and the side at least twice the cut-off
  /// and skin, as an atom would else have neighbours by two images.
  lennard_jones_liquid(Eigen::Index atoms, double density, const lennard_jones_liquid_options& options = {});

  lennard_jones_liquid(const lennard_jones_liquid& other);             ///< with no list yet
  lennard_jones_liquid(lennard_jones_liquid&&) noexcept;               ///< with the other's list
  lennard_jones_liquid& operator=(const lennard_jones_liquid& other);  ///< with no list yet
  lennard_jones_liquid& operator=(lennard_jones_liquid&&) noexcept;    ///< with the other's list
  ~lennard_jones_liquid();

  /// A liquid each of whose forces `threads` threads share, with no list yet. The bits are the same as on one
  /// thread. Throws std::invalid_argument unless threads >= 1.
  lennard_jones_liquid on_threads(int threads) const;

  Eigen::Index size() const { return 3 * atoms_; }
  Eigen::Index atoms() const { return atoms_; }                             ///< N
  double density() const { return density_; }                               ///< N/L^3
  double side() const { return side_; }                                     ///< L
  const lennard_jones_liquid_options& options() const { return options_; }  ///< as they were given
  int threads() const { return threads_; }  ///< number of threads that share a force

  /// V(q). Cost: somewhat less than a force.
  double potential(const Eigen::VectorXd& q) const;
  /// f = -grad V(q)
  void force(const Eigen::VectorXd& q, Eigen::VectorXd& f) const;
  /// g = f'(q) v, without what the jumps at the cut-off would add. Cost: somewhat more than a force.
  void force_derivative(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& g) const;

  /// Sum over pairs of d f, d being the way from one to the other and f the force along it; q and f are not
  /// multiplied, as q depends on the images. Cost: somewhat less than a force.
  double virial(const Eigen::VectorXd& q) const;
  /// (p^2 + virial)/(3 L^3), p^2 being the sum of the squares of the momenta. Cost: a virial.
  double pressure(const phase_point<double, dimension>& x) const;

  /// How many times this object made its list.
  std::int64_t lists_made() const;
  /// Atoms, density, cut-off and smoothness: what the bits depend on.
  std::string description() const;
  /// The description without the number of atoms.
  std::string kind() const;

 private:
  struct scratch;
  scratch& scratch_of_this() const;
  double sum_over_pairs(const Eigen::VectorXd& q, const auto& summand) const;

  Eigen::Index atoms_;
  double density_;
  double side_;
  lennard_jones_liquid_options options_;
  int threads_ = 1;
  mutable std::unique_ptr<scratch> scratch_;
};

}  // namespace nysalt
