// SPDX-License-Identifier: BSL-1.0
// Initial distributions of the bundled systems.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/ensemble.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/lennard_jones_liquid.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt {

/// Positions of a list, such as the draws of a sampler, with momenta of Maxwell's distribution, p_i ~ N(0,
/// m_i kT). Each start takes a position of the list at random, so that starts of one list may share it.
class thermal_positions {
 public:
  /// Positions for a system, whose masses scale the momenta. Throws std::invalid_argument if there is no
  /// position, one does not fit the system or is not finite, or kT is not positive and finite.
  thermal_positions(const model& system, std::vector<Eigen::VectorXd> positions, double temperature);

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const { return description_; }

 private:
  std::shared_ptr<const std::vector<Eigen::VectorXd>> positions_;
  std::vector<double> deviations_;  // of the momenta
  std::string description_;
};

namespace detail {

/// The law of fpu_law.
class fpu_starts {
 public:
  /// Initial states of the soft springs.
  struct soft_motion {
    double displacement = 1.0;  ///< x_0 of every pair
    double velocity = 1.0;      ///< y_0 of every pair
  };

  fpu_starts(Eigen::Index pairs, double omega, double spread, const soft_motion& soft);
  phase_point<double, Eigen::Dynamic> start(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  Eigen::Index pairs_;
  double omega_;
  double spread_;
  soft_motion soft_;
};

/// The law of lennard_jones_law.
class struck_cluster {
 public:
  struck_cluster(Eigen::VectorXd rest, Eigen::Index space, double temperature);
  phase_point<double, Eigen::Dynamic> start(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  Eigen::VectorXd rest_;
  double temperature_;
  std::vector<Eigen::VectorXd> rigid_motions_;  // an orthonormal basis of shifts and turns
};

}  // namespace detail

/// States of the FPU chain [li_lu_tao_ye_2023, equation (5.5)]: x_0 and y_0 as given by a `soft_motion`, and
/// x_1 = 1/omega + zeta, y_1 = 1 + eta, with zeta and eta normal of standard deviation spread/omega. The
/// paper's spread, x_0 and y_0 are 1: nearly harmonic states, which the states of soft_dominated are not.
template <int Pairs>
class fpu_law : public detail::in_dimension<detail::fpu_starts, fpu_chain<Pairs>::dimension> {
 public:
  /// Throws std::invalid_argument if the spread is negative, or it or the soft motion not finite.
  explicit fpu_law(const fpu_chain<Pairs>& chain, double spread = 1.0,
                   const detail::fpu_starts::soft_motion& soft = {})
      : detail::in_dimension<detail::fpu_starts, fpu_chain<Pairs>::dimension>(chain.pairs(), chain.omega(),
                                                                              spread, soft) {}

  /// An initial distribution with the soft energy omega^2, half in motion (m y_0^2/2) and half in the two
  /// springs at the ends (x_0^4/2 together; those between start at rest).
  static fpu_law soft_dominated(const fpu_chain<Pairs>& chain) {
    const auto m = static_cast<double>(chain.pairs());
    return fpu_law(chain, 1.0, {std::sqrt(chain.omega()), chain.omega() / std::sqrt(m)});
  }
};

/// Ellipses of semi-major axis 1 and one eccentricity, run through counterclockwise: their orientation is
/// uniform, and so is the time since the pericentre, as the mean anomaly M. With E - e sin E = M,
///   q = (cos E - e, sqrt(1 - e^2) sin E),  p = (-sin E, sqrt(1 - e^2) cos E)/(1 - e cos E)
/// [hairer_lubich_wanner_2006, section I.2], turned. All have H = -1/2.
class kepler_law {
 public:
  /// Throws std::invalid_argument unless 0 <= eccentricity < 1.
  explicit kepler_law(double eccentricity);

  phase_point<double, 2> operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  /// E of M in -pi..pi, by Newton's method from +-pi: where E - e sin E - M has a curvature of one sign, it
  /// comes nearer from one side until rounding stops it.
  double eccentric_anomaly(double mean) const;

  double eccentricity_;
};

/// A Lennard-Jones cluster at rest is struck: every start is cluster_at_rest with normal momenta of variance
/// kT, projected to where the whole neither moves nor turns. Each of the other directions has kinetic energy
/// kT/2 in the mean, and shares it with the potential later. From some kT = 0.3 on atoms leave.
template <int Space, int Atoms>
class lennard_jones_law
    : public detail::in_dimension<detail::struck_cluster, lennard_jones<Space, Atoms>::dimension> {
 public:
  /// Throws std::invalid_argument if the temperature, an energy, is negative or not finite.
  lennard_jones_law(const lennard_jones<Space, Atoms>& system, double temperature)
      : detail::in_dimension<detail::struck_cluster, lennard_jones<Space, Atoms>::dimension>(
            detail::cluster_at_rest(system), system.space(), temperature) {}
};

/// A crystal that is heated: atoms on a face-centred cubic lattice that fills the box, with normal momenta of
/// variance kT, less their mean. Where there are fewer atoms than sites, 4 n^3, vacancies are spread evenly.
/// Half of the kinetic energy goes into the potential when the crystal melts: kT = 1.44 becomes some 0.72 at
/// the density 0.8442.
class lennard_jones_liquid_law {
 public:
  /// Throws std::invalid_argument if the temperature, an energy, is negative or not finite.
  lennard_jones_liquid_law(const lennard_jones_liquid& system, double temperature);

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  double site_on_axis(Eigen::Index site, Eigen::Index axis) const;

  Eigen::Index atoms_;
  double side_;
  double temperature_;
  Eigen::Index cells_ = 1;  // along each axis
};

}  // namespace nysalt
